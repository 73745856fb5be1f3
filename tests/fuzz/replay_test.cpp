// Inputs that once were findings of a fuzzer, and files that every mutation starts from, given to
// the same readers.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/seeds.h"
#include "tests/fuzz/targets.h"

namespace opaline::fuzz {
namespace {

class Replay : public ::testing::TestWithParam<Target> {};

// An exact copy, so that an address sanitizer sees a read past the end.
void replay(const Target& target, const std::string& bytes) {
    const std::vector<std::byte> exact(
        reinterpret_cast<const std::byte*>(bytes.data()),
        reinterpret_cast<const std::byte*>(bytes.data()) + bytes.size());
    run(target, exact);
}

TEST_P(Replay, FindingsAreRefusedOrHarmless) {
    const auto folder =
        std::filesystem::path(OPALINE_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name;
    if (!std::filesystem::exists(folder)) return;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        SCOPED_TRACE(entry.path());
        std::ifstream in(entry.path(), std::ios::binary);
        replay(GetParam(), {std::istreambuf_iterator<char>(in), {}});
    }
}

// Files that OpenVDB reads are damaged in tests/formats/vdb, where the process that reads them is
// limited.
int count_changes(const Target& target) {
    return std::string_view(target.name) == "vdb" ? 0 : OPALINE_REPLAYS;
}

TEST_P(Replay, PrefixesAndChangedBytesAreRefusedOrHarmless) {
    std::mt19937 random(1);
    for (const std::string& seed : make_seeds(GetParam().name)) {
        replay(GetParam(), seed);
        for (int i = 0; i < count_changes(GetParam()); ++i) {
            replay(GetParam(), seed.substr(0, random() % (seed.size() + 1)));
            std::string changed = seed;
            for (unsigned k = 0; !seed.empty() && k <= random() % 3; ++k) {
                const std::size_t at = random() % std::min<std::size_t>(seed.size(), 400u << i % 8);
                changed[at] = static_cast<char>(random() % 2 == 0 ? random() : random() % 4 - 1);
            }
            replay(GetParam(), changed);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Replay,
                         ::testing::ValuesIn(all_targets().begin(), all_targets().end()),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace opaline::fuzz
