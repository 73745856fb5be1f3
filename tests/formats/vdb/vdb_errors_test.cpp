#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <limits>

#include "tests/formats/vdb/vdb_files.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {
namespace {

using formats::ErrorKind;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::vector<Voxel> kOne = {{{0, 0, 0}, glm::vec3(1)}};

// What reading a file with these grids says; "" if it is read.
std::string fault_of(const std::vector<FileGrid>& grids, const std::vector<std::string>& names = {},
                     const FileOptions& options = {}) {
    const TemporaryFolder folder;
    write_file(folder / "a.vdb", grids, options);
    const auto result = read(folder / "a.vdb", names);
    if (!result) {
        EXPECT_EQ(result.error().kind, ErrorKind::bad_input);
    }
    return message_of(result);
}

TEST(VdbErrors, MissingFilesFoldersAndPipesAreRefused) {
    const TemporaryFolder folder;
    EXPECT_THAT(message_of(read(folder / "none.vdb")), HasSubstr("No such file"));
    EXPECT_THAT(message_of(read(folder.path())), HasSubstr("not a regular file"));
    ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
    EXPECT_THAT(message_of(read(folder / "pipe")), HasSubstr("not a regular file"));
    EXPECT_THAT(message_of(read("/dev/null")), HasSubstr("not a regular file"));
}

TEST(VdbErrors, FilesThatAreNoOpenVdbFilesAreRefused) {
    const TemporaryFolder folder;
    write_bytes(folder / "empty.vdb", "");
    EXPECT_THAT(message_of(read(folder / "empty.vdb")), HasSubstr("is empty"));
    for (const std::string bytes : {"x", " BDV", "glTF and more than eight bytes"}) {
        write_bytes(folder / "a.vdb", bytes);
        EXPECT_THAT(message_of(read(folder / "a.vdb")), HasSubstr("not an OpenVDB file"));
    }
}

TEST(VdbErrors, FileOfAnUnknownVersionIsRefused) {
    const TemporaryFolder folder;
    write_file(folder / "a.vdb", {{.voxels = kOne}});
    for (const char version : {'\x00', '\xdc', '\xff'}) {
        std::string bytes = read_bytes(folder / "a.vdb");
        bytes[8] = version;
        write_bytes(folder / "b.vdb", bytes);
        EXPECT_THAT(message_of(read(folder / "b.vdb")), HasSubstr("version"));
    }
}

TEST(VdbErrors, MissingGridIsToldWithThoseThatAreThere) {
    const std::string said = fault_of({{.name = "density", .voxels = kOne},
                                       {.name = "heat", .values = Values::real64, .voxels = kOne}},
                                      {"density", "Density"});
    EXPECT_THAT(said, AllOf(HasSubstr("no grid 'Density'"), HasSubstr("'density' (float)"),
                            HasSubstr("'heat' (double)")));
}

TEST(VdbErrors, LongListsOfGridsAreCut) {
    std::vector<FileGrid> grids;
    for (int i = 0; i < 100; ++i) {
        grids.push_back({.name = "grid number " + std::to_string(i), .voxels = kOne});
    }
    const std::string said = fault_of(grids, {"x"});
    EXPECT_THAT(said, HasSubstr("'grid number 0'"));
    EXPECT_LT(said.size(), 260u);
    EXPECT_THAT(fault_of(grids), HasSubstr("more than 64 fog volumes"));
}

TEST(VdbErrors, OtherValuesThanFloatsAreRefused) {
    for (const bool has_offsets : {true, false}) {
        const FileOptions options{.has_offsets = has_offsets};
        for (const std::vector<std::string>& names : {std::vector<std::string>{}, {"density"}}) {
            EXPECT_THAT(fault_of({{.values = Values::real64, .voxels = kOne}}, names, options),
                        AllOf(HasSubstr("grid 'density'"), HasSubstr("double")));
            EXPECT_THAT(fault_of({{.values = Values::int32, .voxels = kOne}}, names, options),
                        HasSubstr("int32"));
        }
    }
    EXPECT_THAT(fault_of({{.name = "a", .values = Values::int32, .voxels = kOne},
                          {.name = "b", .kind = Kind::level_set, .voxels = kOne}}),
                AllOf(HasSubstr("no fog volume"), HasSubstr("'a' (int32)"), HasSubstr("'b'")));
}

TEST(VdbErrors, GridOfATypeThatOpenVdbDoesNotKnowIsToldByName) {
    const TemporaryFolder folder;
    write_file(folder / "a.vdb", {{.name = "a", .values = Values::int32, .voxels = kOne},
                                  {.name = "b", .voxels = kOne}});
    std::string bytes = read_bytes(folder / "a.vdb");
    bytes.replace(bytes.find("Tree_int32_"), 10, "Tree_odd99");
    write_bytes(folder / "a.vdb", bytes);
    EXPECT_THAT(message_of(read(folder / "a.vdb", {"a"})), HasSubstr("Tree_odd99"));
    const auto others = read(folder / "a.vdb");
    ASSERT_TRUE(others.has_value()) << message_of(others);
    EXPECT_EQ(others->at(0).name, "b");
}

TEST(VdbErrors, SingularAndInfiniteTransformsAreRefused) {
    const TemporaryFolder folder;
    glm::dmat4 matrix(1);
    matrix[0] = {3, 1, 0, 0};  // not a scale, so the file holds the matrix as it is
    write_file(folder / "a.vdb", {{.transform = matrix, .voxels = kOne}});
    const std::string whole = read_bytes(folder / "a.vdb");
    const double three = 3;
    const std::size_t at =
        whole.find(std::string(reinterpret_cast<const char*>(&three), sizeof(three)));
    ASSERT_NE(at, std::string::npos);
    for (const double value :
         {0.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
        std::string bytes = whole;
        bytes.replace(at, sizeof(value), reinterpret_cast<const char*>(&value), sizeof(value));
        write_bytes(folder / "b.vdb", bytes);
        EXPECT_THAT(message_of(read(folder / "b.vdb")), HasSubstr("transform is singular"));
    }
}

TEST(VdbErrors, WhatIsNoFogVolumeIsRefused) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const Voxel one = kOne[0], off{{0, 0, 0}, glm::vec3(1), false}, zero{{0, 0, 0}, glm::vec3(0)};
    std::vector<Voxel> endless = box_of_voxels({0, 0, 0}, {20, 20, 20}), negative = endless;
    endless[17].value.x = kInfinity;
    negative[17].value.x = -kInfinity;
    const struct {
        FileGrid grid;
        const char* fault;
    } cases[] = {{{.kind = Kind::level_set, .voxels = kOne}, "level set"},
                 {{.values = Values::color, .kind = Kind::staggered, .voxels = kOne}, "staggered"},
                 {{.is_frustum = true, .voxels = kOne}, "frustum"},
                 {{.background = 0.1f, .voxels = kOne}, "background"},
                 {{.background = kNan, .voxels = kOne}, "background"},
                 {{.values = Values::color, .background = 1, .voxels = kOne}, "background"},
                 {{}, "no active voxel"},
                 {{.voxels = {off}}, "no active voxel"},
                 {{.voxels = {zero}}, "no density"},
                 {{.tiles = {{3, {0, 0, 0}, glm::vec3(0)}}}, "no density"},
                 {{.voxels = endless}, "1 voxels are infinite"},
                 {{.voxels = negative}, "1 voxels are infinite"},
                 {{.values = Values::color, .voxels = endless}, "1 voxels are infinite"},
                 {{.values = Values::color, .voxels = negative}, "1 voxels are infinite"},
                 {{.voxels = {one, {{8000, 8000, 8000}, glm::vec3(1)}}}, "too far apart"},
                 {{.voxels = {{{1 << 24, 0, 0}, glm::vec3(1)}}}, "index is beyond"},
                 {{.voxels = {{{0, -(1 << 30), 0}, glm::vec3(1)}}}, "index is beyond"}};
    for (const auto& c : cases) {
        EXPECT_THAT(fault_of({c.grid}, {"density"}), HasSubstr(c.fault));
    }
    EXPECT_THAT(fault_of({}), HasSubstr("has no grid"));
    EXPECT_THAT(fault_of({}, {"density"}), HasSubstr("has no grid"));
}

TEST(VdbErrors, MoreThanAThousandthOfBadValuesIsRefused) {
    std::vector<Voxel> voxels = box_of_voxels({0, 0, 0}, {10, 10, 40});
    for (std::size_t i = 0; i < 4; ++i) {
        voxels[i].value.x = i % 2 == 0 ? -1 : std::numeric_limits<float>::quiet_NaN();
    }
    EXPECT_EQ(fault_of({{.voxels = voxels}}), "");
    voxels[4].value.x = -1;
    EXPECT_THAT(fault_of({{.voxels = voxels}}),
                HasSubstr("of 4000 active voxels 2 are NaN and 3 negative"));
    EXPECT_THAT(fault_of({{.tiles = {{1, {0, 0, 0}, glm::vec3(-1)}}}}), HasSubstr("512 negative"));
}

TEST(VdbErrors, ImpossibleNamesAreRefused) {
    const TemporaryFolder folder;
    write_file(folder / "a.vdb", {{.voxels = kOne}});
    EXPECT_THAT(message_of(read(folder / "a.vdb", {std::string(256, 'x')})),
                HasSubstr("255 bytes"));
    EXPECT_THAT(message_of(read(folder / "a.vdb", {std::string("density\0", 8)})),
                HasSubstr("zero byte"));
    EXPECT_THAT(message_of(read(folder / "a.vdb", {""})), HasSubstr("no grid ''"));
    const auto many = read(folder / "a.vdb", std::vector<std::string>(65, "density"));
    ASSERT_FALSE(many.has_value());
    EXPECT_EQ(many.error().kind, ErrorKind::usage);
}

TEST(VdbErrors, MessagesHoldNoControlCharacters) {
    const std::string said = fault_of({{.name = "a\n\x1b[2J", .voxels = kOne}}, {"b"});
    EXPECT_THAT(said, HasSubstr("'a??[2J'"));
}

}  // namespace
}  // namespace opaline::tests
