#include "formats/vdb/read_vdb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/formats/vdb/vdb_files.h"
#include "tests/support/assets.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {
namespace {

using formats::VdbGrid;

// The grids of a file written with these; a failure of the test if it cannot be read.
std::vector<VdbGrid> written_and_read(const std::vector<FileGrid>& grids,
                                      const std::vector<std::string>& names = {},
                                      const FileOptions& options = {}) {
    const TemporaryFolder folder;
    write_file(folder / "a.vdb", grids, options);
    auto result = read(folder / "a.vdb", names);
    EXPECT_TRUE(result.has_value()) << message_of(result);
    if (!result) return {};
    for (const VdbGrid& grid : *result) {
        EXPECT_TRUE(is_sound(grid)) << grid.name;
    }
    return std::move(*result);
}

std::uint64_t values_above_0(const VdbGrid& grid) {
    return static_cast<std::uint64_t>(std::count_if(
        grid.scalar.value.begin(), grid.scalar.value.end(), [](float v) { return v > 0; }));
}

glm::dvec3 to_scene(const VdbGrid& grid, glm::dvec3 index) {
    const auto& matrix = grid.is_color ? grid.color.to_scene : grid.scalar.to_scene;
    return glm::dvec3(matrix * glm::dvec4(index, 1));
}

TEST(ReadVdb, VoxelsAndOnlyTheyHaveTheirValues) {
    const std::vector<Voxel> voxels = box_of_voxels({-5, 30, 7}, {13, 6, 20});
    for (const FileOptions options :
         {FileOptions{}, FileOptions{.has_offsets = false}, FileOptions{.is_compressed = false}}) {
        const auto grids = written_and_read({{.voxels = voxels}}, {}, options);
        ASSERT_EQ(grids.size(), 1u);
        EXPECT_EQ(grids[0].name, "density");
        EXPECT_FALSE(grids[0].is_color);
        EXPECT_EQ(grids[0].active_voxels, voxels.size());
        EXPECT_EQ(grids[0].not_a_number + grids[0].negative, 0u);
        EXPECT_EQ(values_above_0(grids[0]), voxels.size());
        for (const Voxel& voxel : voxels) {
            EXPECT_EQ(grids[0].scalar.at(voxel.at), voxel.value.x);
        }
        EXPECT_EQ(grids[0].scalar.first_brick, glm::ivec3(-1, 3, 0));
        EXPECT_EQ(grids[0].scalar.extent, glm::ivec3(2, 2, 4));
    }
}

TEST(ReadVdb, InactiveVoxelsAreZeroAndBricksWithoutAValueDropped) {
    const auto grids = written_and_read({{.voxels = {{{0, 0, 0}, glm::vec3(1)},
                                                     {{1, 0, 0}, glm::vec3(7), false},
                                                     {{1000, 0, 0}, glm::vec3(0)}}}});
    ASSERT_EQ(grids.size(), 1u);
    EXPECT_EQ(grids[0].scalar.at({1, 0, 0}), 0.0f);
    EXPECT_EQ(grids[0].scalar.extent, glm::ivec3(1));
    EXPECT_EQ(grids[0].active_voxels, 2u);
}

TEST(ReadVdb, HalvesAreReadAsFloats) {
    const auto grids =
        written_and_read({{.values = Values::half,
                           .voxels = {{{1, 2, 3}, glm::vec3(0.1f)}, {{0, 0, 0}, glm::vec3(3)}}}});
    ASSERT_EQ(grids.size(), 1u);
    EXPECT_NEAR(grids[0].scalar.at({1, 2, 3}), 0.1f, 0.1f / 2048);
    EXPECT_EQ(grids[0].scalar.at({0, 0, 0}), 3.0f);
}

TEST(ReadVdb, ColoursAreReadByChannel) {
    const std::vector<Voxel> voxels = box_of_voxels({-9, 0, 4}, {3, 12, 5});
    const auto grids =
        written_and_read({{.name = "Cd", .values = Values::color, .voxels = voxels}});
    ASSERT_EQ(grids.size(), 1u);
    EXPECT_TRUE(grids[0].is_color);
    for (const Voxel& voxel : voxels) {
        EXPECT_EQ(grids[0].color.at(voxel.at), voxel.value);
    }
    EXPECT_EQ(grids[0].color.at({-10, 0, 4}), glm::vec3(0));
}

TEST(ReadVdb, ActiveTilesAreFilledIn) {
    const auto grids = written_and_read({{.voxels = {{{200, 0, 0}, glm::vec3(2)}},
                                          .tiles = {{1, {8, 16, -8}, glm::vec3(0.25f)},
                                                    {1, {64, 0, 0}, glm::vec3(9), false},
                                                    {2, {-128, 0, 0}, glm::vec3(0.5f)}}}});
    ASSERT_EQ(grids.size(), 1u);
    const auto& density = grids[0].scalar;
    EXPECT_EQ(grids[0].active_voxels, 1u + 512u + 128u * 128 * 128);
    EXPECT_EQ(density.brick_count(), 1u + 1u + 16u * 16 * 16);
    EXPECT_EQ(density.at({8, 16, -8}), 0.25f);
    EXPECT_EQ(density.at({15, 23, -1}), 0.25f);
    EXPECT_EQ(density.at({-128, 127, 127}), 0.5f);
    EXPECT_EQ(density.at({-1, 0, 0}), 0.5f);
    EXPECT_EQ(density.at({0, 0, 0}), 0.0f);
    EXPECT_EQ(density.at({64, 0, 0}), 0.0f);
    EXPECT_EQ(density.at({200, 0, 0}), 2.0f);
}

TEST(ReadVdb, FewBadVoxelsBecomeZeroAndAreCounted) {
    std::vector<Voxel> voxels = box_of_voxels({0, 0, 0}, {20, 20, 20});  // 8000
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    for (int i = 0; i < 3; ++i) {
        voxels[static_cast<std::size_t>(5 * i)].value = glm::vec3(kNan);
        voxels[static_cast<std::size_t>(7 + 5 * i)].value.y = -1;
        voxels[static_cast<std::size_t>(7 + 5 * i)].value.x = -2;
    }
    voxels[5].value = {1, kNan, -1};  // of a scalar: 1
    const auto scalars = written_and_read({{.voxels = voxels}});
    ASSERT_EQ(scalars.size(), 1u);
    EXPECT_EQ(scalars[0].not_a_number, 2u);
    EXPECT_EQ(scalars[0].negative, 3u);
    EXPECT_EQ(scalars[0].scalar.at(voxels[0].at), 0.0f);
    EXPECT_EQ(scalars[0].scalar.at(voxels[7].at), 0.0f);
    EXPECT_EQ(values_above_0(scalars[0]), 8000u - 5);
    const auto colors = written_and_read({{.values = Values::color, .voxels = voxels}});
    ASSERT_EQ(colors.size(), 1u);
    EXPECT_EQ(colors[0].not_a_number, 3u);
    EXPECT_EQ(colors[0].negative, 3u);
    EXPECT_EQ(colors[0].color.at(voxels[5].at), glm::vec3(1, 0, 0));
    EXPECT_EQ(colors[0].color.at(voxels[7].at), glm::vec3(0, 0, voxels[7].value.z));
}

TEST(ReadVdb, TransformsOfAllAffineKindsAreTheFilesOwn) {
    glm::dmat4 sheared(1);
    sheared[0] = {0.1, 0.02, 0, 0};
    sheared[1] = {0.03, -0.2, 0.01, 0};
    sheared[2] = {0, 0.3, 0.5, 0};
    sheared[3] = {10, -20, 30, 1};
    glm::dmat4 anisotropic(1);
    anisotropic[0][0] = 0.5;
    anisotropic[1][1] = 2;
    anisotropic[2][2] = -0.125;
    glm::dmat4 far_away(1);
    far_away[0][0] = far_away[1][1] = far_away[2][2] = 1.0 / 1024;
    far_away[3] = {1 << 30, 0, 0, 1};
    for (const glm::dmat4& matrix : {glm::dmat4(1), sheared, anisotropic, far_away}) {
        const auto grids =
            written_and_read({{.transform = matrix, .voxels = {{{0, 0, 0}, glm::vec3(1)}}}});
        ASSERT_EQ(grids.size(), 1u);
        EXPECT_EQ(grids[0].scalar.to_scene, matrix);
    }
}

TEST(ReadVdb, NamedGridsComeInTheOrderAskedFor) {
    const std::vector<Voxel> one = {{{0, 0, 0}, glm::vec3(1)}}, two = {{{0, 0, 0}, glm::vec3(2)}};
    const std::vector<FileGrid> file = {{.name = "a", .voxels = one},
                                        {.name = "real", .values = Values::real64, .voxels = one},
                                        {.name = "b", .values = Values::color, .voxels = two},
                                        {.name = "surface", .kind = Kind::level_set, .voxels = one},
                                        {.name = "c", .kind = Kind::unknown, .voxels = two}};
    for (const bool has_offsets : {true, false}) {
        const auto some = written_and_read(file, {"c", "a"}, {.has_offsets = has_offsets});
        ASSERT_EQ(some.size(), 2u);
        EXPECT_EQ(some[0].name, "c");
        EXPECT_EQ(some[0].scalar.at({0, 0, 0}), 2.0f);
        EXPECT_EQ(some[1].name, "a");
        const auto all = written_and_read(file, {}, {.has_offsets = has_offsets});
        ASSERT_EQ(all.size(), 1u) << "the only one that its file calls a fog volume";
        EXPECT_EQ(all[0].name, "a");
    }
}

// Grids that simulators write beside a density.
TEST(ReadVdb, DensityIsReadWhateverElseTheFileHolds) {
    const std::vector<Voxel> falling = {{{0, 0, 0}, glm::vec3(-2)}, {{1, 0, 0}, glm::vec3(1)}};
    const std::vector<Voxel> one = {{{0, 0, 0}, glm::vec3(1)}};
    std::vector<FileGrid> file = {{.name = "vel.x", .voxels = falling},
                                  {.name = "velocity", .values = Values::color, .voxels = falling},
                                  {.name = "flames"},
                                  {.name = "temperature", .background = 1, .voxels = one},
                                  {.name = "density", .voxels = one},
                                  {.name = "fuel", .voxels = one}};
    const TemporaryFolder folder;
    for (const char* const name : {"density", "Density", "smoke_density", "Smoke", "rho"}) {
        file[4].name = name;
        write_file(folder / "a.vdb", file);
        std::vector<std::string> unread;
        const auto grids = formats::read_vdb(folder / "a.vdb", {}, with_program(), &unread);
        ASSERT_TRUE(grids) << message_of(grids);
        EXPECT_EQ(grids->front().name, name);
        EXPECT_EQ(grids->size(), 1u);
        EXPECT_EQ(grids->size() + unread.size(), file.size());
        EXPECT_EQ(std::count(unread.begin(), unread.end(), "vel.x"), 1);
    }
}

// Rounding of a solver: a thousandth of the largest value is none.
TEST(ReadVdb, NegativeValuesOfRoundingAreZero) {
    std::vector<Voxel> voxels = box_of_voxels({0, 0, 0}, {8, 8, 8});
    voxels[0].value.x = 5;
    for (std::size_t i = 1; i < 100; ++i) {
        voxels[i].value.x = i % 2 == 0 ? -1e-16f : -4e-3f;
    }
    const auto grids = written_and_read({{.voxels = voxels}});
    ASSERT_EQ(grids.size(), 1u);
    EXPECT_EQ(grids[0].negative, 0u);
    EXPECT_EQ(grids[0].scalar.at(voxels[1].at), 0.0f);
    for (std::size_t i = 1; i < 100; ++i) {
        voxels[i].value.x = -6e-3f;
    }
    const TemporaryFolder folder;
    write_file(folder / "a.vdb", {{.voxels = voxels}});
    EXPECT_NE(message_of(read(folder / "a.vdb")), "");
}

TEST(ReadVdb, GridsOfTheSameNameAreNumbered) {
    const std::vector<FileGrid> file = {{.name = "smoke", .voxels = {{{0, 0, 0}, glm::vec3(1)}}},
                                        {.name = "smoke", .voxels = {{{0, 0, 0}, glm::vec3(2)}}}};
    const auto second = written_and_read(file, {"smoke[1]"});
    ASSERT_EQ(second.size(), 1u);
    EXPECT_EQ(second[0].scalar.at({0, 0, 0}), 2.0f);
    const auto first = written_and_read(file, {"smoke"});
    ASSERT_EQ(first.size(), 1u);
    EXPECT_EQ(first[0].scalar.at({0, 0, 0}), 1.0f);
}

TEST(ReadVdb, GridsThatShareATreeHaveTheirOwnTransforms) {
    glm::dmat4 doubled(2);
    doubled[3][3] = 1;
    const std::vector<FileGrid> file = {
        {.name = "a", .voxels = box_of_voxels({0, 0, 0}, {9, 9, 9})},
        {.name = "b", .transform = doubled, .shares_tree = true}};
    for (const bool has_offsets : {true, false}) {
        const auto grids = written_and_read(file, {}, {.has_offsets = has_offsets});
        ASSERT_EQ(grids.size(), 2u);
        EXPECT_EQ(grids[0].scalar.value, grids[1].scalar.value);
        EXPECT_EQ(to_scene(grids[0], {1, 2, 3}), glm::dvec3(1, 2, 3));
        EXPECT_EQ(to_scene(grids[1], {1, 2, 3}), glm::dvec3(2, 4, 6));
    }
}

TEST(ReadVdb, UnusualPathsAndNamesAreNoOptions) {
    const TemporaryFolder folder;
    const std::string name = "--help\n\x1b[31m; rm 'x'";
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(folder.path());
    for (const std::string path : {"-rf", "two\nlines.vdb", " ", "--opaline-read-vdb"}) {
        write_file(path, {{.name = name, .voxels = {{{0, 0, 0}, glm::vec3(1)}}}});
        const auto result = read(path, {name});
        ASSERT_TRUE(result.has_value()) << message_of(result);
        EXPECT_EQ(result->at(0).name, name);
    }
    std::filesystem::current_path(before);
}

TEST(ReadVdb, CloudOfATeapotIsThere) {
    OPALINE_ASSET(path, "vdb/teapot_cloud.vdb");
    const auto result = read(path);
    ASSERT_TRUE(result.has_value()) << message_of(result);
    ASSERT_EQ(result->size(), 1u);
    const VdbGrid& cloud = result->front();
    EXPECT_TRUE(is_sound(cloud));
    EXPECT_NEAR(static_cast<double>(cloud.active_voxels), 1.96e6, 1e4);
    EXPECT_LE(std::abs(cloud.scalar.extent.x * 8 - 267), 16);
    EXPECT_LE(std::abs(cloud.scalar.extent.y * 8 - 134), 16);
    EXPECT_LE(std::abs(cloud.scalar.extent.z * 8 - 178), 16);
}

}  // namespace
}  // namespace opaline::tests
