// What libFuzzer calls. The target is named by the environment variable OPALINE_FUZZ_TARGET, which
// the processes that libFuzzer starts inherit.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

#include "tests/fuzz/mutators.h"
#include "tests/fuzz/targets.h"

extern "C" {
std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned seed);
}

namespace opaline::fuzz {
namespace {

const Target& chosen_target() {
    static const Target& chosen = []() -> const Target& {
        const char* const name = std::getenv("OPALINE_FUZZ_TARGET");
        for (const Target& target : all_targets()) {
            if (name != nullptr && std::strcmp(name, target.name) == 0) return target;
        }
        std::fprintf(stderr, "OPALINE_FUZZ_TARGET names none of the targets:\n");
        for (const Target& target : all_targets()) {
            std::fprintf(stderr, "%s\n", target.name);
        }
        std::exit(2);
    }();
    return chosen;
}

}  // namespace

Blob mutate_bytes(const Blob& bytes, std::size_t most) {
    Blob room(std::max<std::size_t>(std::max(most, bytes.size()), 1));
    std::copy(bytes.begin(), bytes.end(), room.begin());
    room.resize(LLVMFuzzerMutate(room.data(), bytes.size(), room.size()));
    return room;
}

}  // namespace opaline::fuzz

using namespace opaline::fuzz;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    run(chosen_target(), std::as_bytes(std::span(data, size)));
    return 0;
}

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                    unsigned seed) {
    const std::string_view name = chosen_target().name;
    const Blob bytes(data, data + size);
    Blob changed;
    if (name.starts_with("opal")) {
        changed = mutate_opal(bytes, seed, most);
    } else if (name == "gltf") {
        changed = mutate_glb(bytes, seed, most);
    } else if (name == "media") {
        const std::string json = mutate_json(std::string(bytes.begin(), bytes.end()), seed, most);
        changed.assign(json.begin(), json.end());
    }
    if (changed.empty() || changed.size() > most) return LLVMFuzzerMutate(data, size, most);
    std::copy(changed.begin(), changed.end(), data);
    return changed.size();
}
