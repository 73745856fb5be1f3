#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cstring>
#include <random>

#include "tests/formats/vdb/vdb_files.h"
#include "tests/support/assets.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {
namespace {

using formats::VdbGrid;
using Clock = std::chrono::steady_clock;

constexpr int kSlower = OPALINE_SANITIZED ? 10 : 1;  // starting the process alone

// Two grids, with leaves, tiles, halves and colours.
std::string small_file(const FileOptions& options = {}) {
    const TemporaryFolder folder;
    write_file(
        folder / "a.vdb",
        {{.values = Values::half,
          .voxels = box_of_voxels({-3, 2, 0}, {12, 7, 9}),
          .tiles = {{1, {64, 0, 0}, glm::vec3(1)}, {2, {128, 0, 0}, glm::vec3(0.1f)}}},
         {.name = "Cd", .values = Values::color, .voxels = box_of_voxels({0, 0, 0}, {5, 5, 5})}},
        options);
    return read_bytes(folder / "a.vdb");
}

// Valid grids or an error with a message, and nothing else: a reader that hangs is ended by its
// limit of processor time, which is no fault of these files. Whether it was read.
bool read_damaged(const std::filesystem::path& path, const std::string& bytes) {
    write_bytes(path, bytes);
    const auto result = read(path);
    if (!result) {
        EXPECT_EQ(result.error().kind, formats::ErrorKind::bad_input);
        EXPECT_FALSE(result.error().diagnostics.at(0).fault.empty());
        EXPECT_FALSE(result.error().diagnostics.at(0).remedy.empty());
        EXPECT_EQ(result.error().diagnostics.at(0).fault.find("s of computing"), std::string::npos);
        return false;
    }
    EXPECT_FALSE(result->empty());
    for (const VdbGrid& grid : *result) {
        EXPECT_TRUE(is_sound(grid));
    }
    return true;
}

// The peak of this process, not of those that read [bytes].
std::uint64_t peak_memory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) << 10;
}

// A file with one grid of which the bytes after the transform are these.
std::string with_tree(const std::string& tree) {
    const TemporaryFolder folder;
    write_file(folder / "a.vdb", {{.voxels = {{{0, 0, 0}, glm::vec3(1)}}}}, {.has_offsets = false});
    std::string bytes = read_bytes(folder / "a.vdb");
    // An identity is a map of scale 1: name, then 5 triples of doubles, and the tree after them.
    const std::size_t map = bytes.find("UniformScaleMap");
    EXPECT_NE(map, std::string::npos);
    return bytes.substr(0, map + 15 + 5 * 3 * sizeof(double)) + tree;
}

template <class... T>
std::string raw(const T&... values) {
    std::string bytes;
    ((bytes += std::string(reinterpret_cast<const char*>(&values), sizeof(values))), ...);
    return bytes;
}

TEST(HostileVdb, NoPrefixIsTakenForTheWholeFile) {
    const TemporaryFolder folder;
    for (const bool has_offsets : {true, false}) {
        const std::string whole = small_file({.has_offsets = has_offsets});
        ASSERT_TRUE(read_damaged(folder / "a.vdb", whole));
        const std::size_t step = whole.size() / 70 * kSlower + 1;
        for (std::size_t length = 0; length < whole.size(); length += step) {
            EXPECT_FALSE(read_damaged(folder / "a.vdb", whole.substr(0, length))) << length;
        }
        EXPECT_FALSE(read_damaged(folder / "a.vdb", whole.substr(0, whole.size() - 1)));
    }
}

TEST(HostileVdb, FlippedBytesAreRefusedOrHarmless) {
    const TemporaryFolder folder;
    std::mt19937 random(1);
    for (const bool is_compressed : {false, true}) {
        const std::string whole = small_file({.is_compressed = is_compressed});
        for (int i = 0; i < (OPALINE_SANITIZED ? 3 : 60); ++i) {
            std::string bytes = whole;
            for (unsigned k = 0; k < 1 + random() % 3; ++k) {
                bytes[random() % bytes.size()] = static_cast<char>(random());
            }
            read_damaged(folder / "a.vdb", bytes);
        }
    }
    EXPECT_LT(peak_memory(), 2ull << 30);
}

TEST(HostileVdb, CountsSetToExtremesAreRefusedOrHarmless) {
    const TemporaryFolder folder;
    const std::string whole = small_file();
    std::mt19937 random(2);
    for (int i = 0; i < 60 / kSlower; ++i) {
        std::string bytes = whole;
        // Mostly before the leaves, where counts and sizes are.
        const std::size_t at = 8 + random() % (i % 2 == 0 ? 1200 : bytes.size() - 16);
        const std::uint64_t value = i % 3 == 0   ? ~0ull
                                    : i % 3 == 1 ? 0x7fffffff7fffffffull
                                                 : 0x10000000ull;
        std::memcpy(bytes.data() + at, &value, i % 5 == 0 ? 8 : 4);
        read_damaged(folder / "a.vdb", bytes);
    }
    EXPECT_LT(peak_memory(), 2ull << 30);
}

TEST(HostileVdb, DamagedCloudIsRefusedOrHarmless) {
    OPALINE_ASSET(path, "vdb/teapot_cloud.vdb");
    const TemporaryFolder folder;
    const std::string whole = read_bytes(path);
    std::mt19937 random(3);
    for (int i = 0; i < 20 / kSlower; ++i) {
        std::string bytes = whole;
        for (unsigned k = 0; k < 20; ++k) {
            bytes[random() % bytes.size()] = static_cast<char>(random());
        }
        read_damaged(folder / "a.vdb", bytes);
    }
    EXPECT_FALSE(read_damaged(folder / "a.vdb", whole.substr(0, whole.size() / 2)));
}

TEST(HostileVdb, GiantTilesAreRefusedQuicklyAndWithoutMemory) {
    const TemporaryFolder folder;
    const auto start = Clock::now();
    const std::uint64_t before = peak_memory();
    for (const FileGrid& grid :
         {FileGrid{.tiles = {{3, {0, 0, 0}, glm::vec3(1)}}},
          FileGrid{.tiles = {{3, {0, 0, 0}, glm::vec3(1)}, {3, {1 << 30, 0, 0}, glm::vec3(1)}}},
          FileGrid{.voxels = box_of_voxels({0, 0, 0}, {2, 2, 2}),
          .tiles = {{3, {-4096, -4096, -4096}, glm::vec3(1)}}},
          FileGrid{.values = Values::color, .tiles = {{3, {0, 0, 0}, glm::vec3(1)}}}}) {
        write_file(folder / "a.vdb", {grid});
        const auto result = read(folder / "a.vdb");
        EXPECT_NE(message_of(result).find("blocks of 8 x 8 x 8"), std::string::npos)
            << message_of(result);
    }
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(5 * kSlower));
    EXPECT_LT(peak_memory() - before, 64u << 20);
}

TEST(HostileVdb, LimitOfBricksHoldsForAllGridsTogether) {
    const TemporaryFolder folder;
    // 4^3 tiles of 16^3 bricks are exactly the limit.
    std::vector<Tile> tiles;
    for (int i = 0; i < 64; ++i) {
        tiles.push_back({2, {128 * (i % 4), 128 * (i / 4 % 4), 128 * (i / 16)}, glm::vec3(1)});
    }
    write_file(folder / "a.vdb", {{.tiles = tiles}});
    const auto most = read(folder / "a.vdb");
    ASSERT_TRUE(most.has_value()) << message_of(most);
    EXPECT_EQ(most->at(0).scalar.brick_count(), 1u << 18);
    write_file(folder / "a.vdb", {{.name = "a", .tiles = tiles},
                                  {.name = "b", .voxels = box_of_voxels({0, 0, 0}, {1, 1, 1})}});
    EXPECT_NE(message_of(read(folder / "a.vdb")).find("grid 'b'"), std::string::npos);
}

TEST(HostileVdb, RootWithAbsurdCountsIsRefused) {
    const TemporaryFolder folder;
    const std::string buffers = raw(std::int32_t{1}, 0.0f);  // number of buffers, background
    const std::string tile = raw(std::int32_t{0}, std::int32_t{0}, std::int32_t{0}, 1.0f, true);
    write_bytes(folder / "a.vdb", with_tree(buffers + raw(1u, 0u) + tile));
    EXPECT_NE(message_of(read(folder / "a.vdb")).find("blocks of 8 x 8 x 8"), std::string::npos)
        << "the only bytes that are right";
    for (const std::uint32_t tiles : {0u, 1u, 0x7fffffffu, 0xffffffffu}) {
        for (const std::uint32_t children : {0u, 1u, 0x7fffffffu, 0xffffffffu}) {
            std::string bytes = with_tree(buffers + raw(tiles, children));
            EXPECT_FALSE(read_damaged(folder / "a.vdb", bytes));
            bytes.append(1u << 16, '\xff');
            EXPECT_FALSE(read_damaged(folder / "a.vdb", bytes));
        }
    }
}

TEST(HostileVdb, NodesWithoutEndAreRefused) {
    const TemporaryFolder folder;
    // A million children of the root at places of their own, each with every bit of its masks set.
    std::string tree = raw(std::int32_t{1}, 0.0f, 0u, 1000000u);
    for (std::int32_t i = 0; i < 400; ++i) {
        tree += raw(i * 4096, std::int32_t{0}, std::int32_t{0});
        tree.append(2 * 32768 / 8, '\xff');
    }
    EXPECT_FALSE(read_damaged(folder / "a.vdb", with_tree(tree)));
}

TEST(HostileVdb, MemoryOfTheReaderIsLimited) {
    if (OPALINE_SANITIZED) GTEST_SKIP() << "a sanitizer needs address space without limit";
    const TemporaryFolder folder;
    write_file(folder / "a.vdb", {{.voxels = box_of_voxels({0, 0, 0}, {100, 100, 100})}});
    formats::VdbReadOptions options = with_program();
    options.memory_bytes = 16u << 20;
    const auto result = formats::read_vdb(folder / "a.vdb", {}, options);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, formats::ErrorKind::bad_input);
}

}  // namespace
}  // namespace opaline::tests
