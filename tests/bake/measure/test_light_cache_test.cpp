#include "bake/lights/test_lights.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

std::string read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void expect_same(const std::vector<TestLight>& a, const std::vector<TestLight>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t l = 0; l < a.size(); ++l) {
        EXPECT_EQ(a[l].name, b[l].name);
        EXPECT_EQ(a[l].smooth, b[l].smooth);
        EXPECT_EQ(a[l].coarse, b[l].coarse);
        ASSERT_EQ(a[l].discs.size(), b[l].discs.size());
        for (std::size_t d = 0; d < a[l].discs.size(); ++d) {
            EXPECT_EQ(a[l].discs[d].direction, b[l].discs[d].direction);
            EXPECT_EQ(a[l].discs[d].angular_radius, b[l].discs[d].angular_radius);
            EXPECT_EQ(a[l].discs[d].flux, b[l].discs[d].flux);
        }
    }
}

TEST(TestLightCache, LightsFromTheCacheAreTheSameBits) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path file = folder / "new" / "lights";
    EXPECT_TRUE(read_test_lights(file).empty());
    const auto plain = make_test_lights(16, 2), first = make_test_lights(16, 2, file);
    ASSERT_TRUE(plain && first);
    ASSERT_EQ(read_test_lights(file).size(), published_lights().size());
    const auto second = make_test_lights(16, 2, file);
    ASSERT_TRUE(second);
    expect_same(*plain, *first);
    expect_same(*plain, *second);
}

TEST(TestLightCache, DamagedFilesAreNotUsed) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path file = folder / "lights";
    ASSERT_TRUE(make_test_lights(8, 2, file));
    const std::string whole = read(file);
    for (std::size_t at = 0; at < whole.size(); at += whole.size() / 50) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
        std::ofstream(file, std::ios::binary) << damaged;
        EXPECT_TRUE(read_test_lights(file).empty()) << at;
        std::ofstream(file, std::ios::binary) << whole.substr(0, at);
        EXPECT_TRUE(read_test_lights(file).empty()) << at;
    }
    std::ofstream(file, std::ios::binary) << whole;
    EXPECT_FALSE(read_test_lights(file).empty());
}

TEST(TestLightCache, CacheThatCannotBeWrittenChangesNothing) {
    EXPECT_TRUE(make_test_lights(8, 2, "/proc/no/such/folder/lights"));
}

}  // namespace
}  // namespace opaline::bake
