#include "formats/vdb/write_vdb.h"

#include <gmock/gmock.h>

#include <limits>

#include "tests/formats/vdb/vdb_files.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {
namespace {

using formats::SparseGrid;
using formats::VdbOutputGrid;
using formats::write_vdb;

// Three bricks at the corners of a table of 3 x 2 x 4, half of the voxels 0.
SparseGrid<float> three_bricks() {
    SparseGrid<float> grid;
    grid.first_brick = {-2, 5, 0};
    grid.extent = {3, 2, 4};
    grid.table.assign(24, grid.kEmpty);
    grid.table[0] = 0;
    grid.table[10] = 1;
    grid.table[23] = 2;
    for (std::size_t i = 0; i < 3 * 512; ++i) {
        grid.value.push_back(i % 2 == 0 ? 0 : 1.0f / static_cast<float>(i));
    }
    grid.to_scene[0] = {0.1, 0.02, 0, 0};
    grid.to_scene[1] = {0.03, 0.2, 0.01, 0};
    grid.to_scene[2] = {0, 0.3, 0.5, 0};
    grid.to_scene[3] = {10, -20, 30, 1};
    return grid;
}

std::string fault_of(const VdbOutputGrid& grid) {
    const TemporaryFolder folder;
    const auto status = write_vdb(folder / "a.vdb", {{grid}});
    EXPECT_FALSE(std::filesystem::exists(folder / "a.vdb"));
    return status ? "" : status.error().diagnostics.at(0).fault;
}

TEST(WriteVdb, WhatWasWrittenIsReadBack) {
    const TemporaryFolder folder;
    const SparseGrid<float> grid = three_bricks();
    ASSERT_TRUE(write_vdb(folder / "a.vdb", {{{.name = "density", .grid = &grid}}}));
    const auto result = read(folder / "a.vdb", {"density"});
    ASSERT_TRUE(result.has_value()) << message_of(result);
    const SparseGrid<float>& back = result->front().scalar;
    EXPECT_EQ(back.first_brick, grid.first_brick);
    EXPECT_EQ(back.extent, grid.extent);
    EXPECT_EQ(back.table, grid.table);
    EXPECT_EQ(back.value, grid.value);
    EXPECT_EQ(back.to_scene, grid.to_scene);
    EXPECT_TRUE(openvdb_finds(folder / "a.vdb", "density", grid));
}

TEST(WriteVdb, TransformsKeepAllDigitsFarFromTheOrigin) {
    const TemporaryFolder folder;
    SparseGrid<float> grid = three_bricks();
    for (const glm::dvec3 scale : {glm::dvec3(0.001), glm::dvec3(0.001, 0.2, -3)}) {
        grid.to_scene = glm::dmat4(1);
        for (int axis = 0; axis < 3; ++axis) {
            grid.to_scene[axis][axis] = scale[axis];
            grid.to_scene[3][axis] = 1e9 / (axis + 1);
        }
        ASSERT_TRUE(write_vdb(folder / "a.vdb", {{{.name = "a", .grid = &grid}}}));
        const auto result = read(folder / "a.vdb");
        ASSERT_TRUE(result.has_value()) << message_of(result);
        EXPECT_EQ(result->front().scalar.to_scene, grid.to_scene);
    }
}

TEST(WriteVdb, HalvesAreRoundedAndTakeLessRoom) {
    const TemporaryFolder folder;
    const SparseGrid<float> grid = three_bricks();
    ASSERT_TRUE(write_vdb(folder / "a.vdb", {{{.name = "a", .grid = &grid}}}));
    ASSERT_TRUE(write_vdb(folder / "b.vdb", {{{.name = "a", .grid = &grid, .is_half = true}}}));
    EXPECT_LT(std::filesystem::file_size(folder / "b.vdb"),
              std::filesystem::file_size(folder / "a.vdb"));
    const auto result = read(folder / "b.vdb");
    ASSERT_TRUE(result.has_value()) << message_of(result);
    const SparseGrid<float>& back = result->front().scalar;
    ASSERT_EQ(back.value.size(), grid.value.size());
    for (std::size_t i = 0; i < grid.value.size(); ++i) {
        EXPECT_NEAR(back.value[i], grid.value[i], grid.value[i] / 2048);
    }
}

TEST(WriteVdb, SeveralGridsStandInOneFile) {
    const TemporaryFolder folder;
    const SparseGrid<float> grid = three_bricks();
    SparseGrid<float> plain = grid;
    plain.to_scene = glm::dmat4(1);
    ASSERT_TRUE(write_vdb(folder / "a.vdb", {{{.name = "a", .grid = &grid, .is_half = true},
                                              {.name = "b", .grid = &plain}}}));
    const auto result = read(folder / "a.vdb");
    ASSERT_TRUE(result.has_value()) << message_of(result);
    ASSERT_EQ(result->size(), 2u);
    EXPECT_EQ(result->at(1).scalar.to_scene, glm::dmat4(1));
    EXPECT_EQ(result->at(1).scalar.value, grid.value);
}

TEST(WriteVdb, BytesAreTheSameOnEveryRunAndTheIdentifierFollowsThem) {
    const TemporaryFolder folder;
    SparseGrid<float> grid = three_bricks();
    const auto bytes = [&] {
        EXPECT_TRUE(write_vdb(folder / "a.vdb", {{{.name = "density", .grid = &grid}}}));
        return read_bytes(folder / "a.vdb");
    };
    const std::string first = bytes();
    EXPECT_EQ(bytes(), first);
    grid.value[1] = 0.75f;
    EXPECT_NE(bytes().substr(21, 36), first.substr(21, 36));
    EXPECT_EQ(first.substr(21, 36).find_first_not_of("0123456789abcdef-"), std::string::npos);
}

TEST(WriteVdb, WhatNoFogVolumeHasIsRefused) {
    SparseGrid<float> grid = three_bricks();
    const auto expect_fault = [&](const char* fault, bool is_half = false) {
        EXPECT_THAT(fault_of({.name = "a", .grid = &grid, .is_half = is_half}),
                    testing::HasSubstr(fault));
    };
    EXPECT_THAT(fault_of({.name = "", .grid = &grid}), testing::HasSubstr("name"));
    grid.value[3] = -1;
    expect_fault("negative");
    grid.value[3] = std::numeric_limits<float>::quiet_NaN();
    expect_fault("finite");
    grid.value[3] = 70000;
    expect_fault("65504", true);
    grid.to_scene[1] = {0, 0, 0, 0};
    expect_fault("transform");
    grid.to_scene = glm::dmat4(1e-6);
    grid.to_scene[3][3] = 1;
    expect_fault("too small");
    const SparseGrid<float> empty;
    EXPECT_THAT(fault_of({.name = "a", .grid = &empty}), testing::HasSubstr("no value"));
    const TemporaryFolder folder;
    grid = three_bricks();
    EXPECT_FALSE(write_vdb(folder / "a.vdb",
                           {{{.name = "a", .grid = &grid}, {.name = "a", .grid = &grid}}}));
    EXPECT_FALSE(write_vdb(folder.path() / "none" / "a.vdb", {{{.name = "a", .grid = &grid}}}));
}

}  // namespace
}  // namespace opaline::tests
