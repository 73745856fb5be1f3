// Volumes that are written come back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/volume_fixture.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;
using tests::expect_same_bytes;
using tests::StoredAsset;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

void expect_same_volumes(const VolumesView& a, const VolumesView& b) {
    expect_same_bytes(a.records, b.records);
    expect_same_bytes(a.table, b.table);
    expect_same_bytes(a.density_scale, b.density_scale);
    expect_same_bytes(a.density, b.density);
    expect_same_bytes(a.corner, b.corner);
    expect_same_bytes(a.node, b.node);
    expect_same_bytes(a.phase, b.phase);
    tests::expect_same_rows(a.rows, b.rows);
}

TEST(VolumesFile, ReturnsEveryValueInPlaceWithoutAnyPrimitive) {
    for (const std::uint32_t bits : {8u, 16u}) {
        const Asset asset = tests::make_volume_asset(bits);
        StoredAsset stored(asset);
        const AssetView& view = stored.view();
        const VolumesView& volumes = view.volumes;
        EXPECT_EQ(view.cubemap_size, 8u);
        EXPECT_TRUE(view.primitives.empty() && view.position.empty() && view.index.empty());
        EXPECT_EQ(view.transport.rows(), 0u);
        expect_same_volumes(volumes, asset.volumes.view());
        EXPECT_TRUE(stored.holds(volumes.records) && stored.holds(volumes.density));
        EXPECT_TRUE(stored.holds(volumes.corner) && stored.holds(volumes.phase));
        EXPECT_TRUE(bits == 16 || stored.holds(volumes.rows.code8));
        EXPECT_EQ(stored.version_of(kVoluSection), 1u);
        EXPECT_EQ(opal_size(asset.view()), stored.stored.bytes().size());
    }
}

TEST(VolumesFile, StandsBesidePrimitivesAndIsAbsentWithoutVolumes) {
    Asset asset = tests::make_small_asset();
    const StoredAsset surface(asset);
    EXPECT_TRUE(surface.view().volumes.empty());
    EXPECT_EQ(surface.version_of(kVoluSection), 0u);
    tests::add_volume(asset, {.single_terms = 0, .multiple_terms = 9});
    tests::add_volume(asset, {.spacing = 8, .single_terms = 0, .multiple_terms = 0});
    tests::add_volume(asset, {.spacing = 1, .single_terms = 25, .multiple_terms = 0});
    const StoredAsset stored(asset);
    expect_same_volumes(stored.view().volumes, asset.volumes.view());
    EXPECT_EQ(stored.view().primitives.size(), 2u);
}

TEST(VolumesFile, RowsOfLargeCubeMapsHaveFourByteIndices) {
    Asset asset;
    asset.transport = make_sparse_rows(128, 8);
    tests::add_volume(asset, {.spacing = 8, .multiple_terms = 0, .bricks_along_x = 1});
    const StoredAsset stored(asset);
    EXPECT_GT(stored.view().volumes.rows.index32.size(), 0u);
    expect_same_volumes(stored.view().volumes, asset.volumes.view());
}

// The fault of the asset of the fixture after a change, under the checks given.
template <class Change>
std::string fault_of(Checks checks, Change change) {
    return tests::fault_after(
        tests::make_volume_asset(), [&](Asset& asset) { change(asset.volumes); }, checks);
}

template <class Change>
std::string structure_fault(Change change) {
    return fault_of(Checks::structure, change);
}

// Of a change that the check of the structure lets pass.
template <class Change>
std::string value_fault(Change change) {
    EXPECT_EQ(structure_fault(change), "");
    return fault_of(Checks::full, change);
}

template <class Change>
void expect_volume_fault(const char* what, Change change) {
    EXPECT_THAT(structure_fault(change), HasSubstr(what));
}

TEST(VolumesFile, ImpossibleRecordsAreRefusedByName) {
    EXPECT_EQ(structure_fault([](Volumes&) {}), "");
    for (const std::uint32_t spacing : {0u, 3u, 16u, 0xffffffffu}) {
        EXPECT_THAT(structure_fault([=](Volumes& v) { v.records[1].spacing = spacing; }),
                    HasSubstr("section VOLU, volume 1: nodes every " + std::to_string(spacing)));
    }
    for (const std::uint32_t terms : {2u, 5u, 36u, 0xffffffffu}) {
        EXPECT_THAT(structure_fault([=](Volumes& v) { v.records[0].single_terms = terms; }),
                    HasSubstr("terms of single scattering"));
        EXPECT_THAT(structure_fault([=](Volumes& v) { v.records[0].multiple_terms = terms; }),
                    HasSubstr("terms of single scattering"));
    }
    for (const std::uint32_t bands : {0u, 2u, 4u, 0xffffffffu}) {
        EXPECT_THAT(structure_fault([=](Volumes& v) { v.records[0].bands = bands; }),
                    HasSubstr("1 or 3 bands"));
    }
    for (const std::int32_t first : {1 << 22, -(1 << 22) - 1, INT32_MIN, INT32_MAX}) {
        EXPECT_THAT(structure_fault([=](Volumes& v) { v.records[0].first_brick[1] = first; }),
                    HasSubstr("from the origin"));
    }
}

TEST(VolumesFile, MatricesWithoutAnInverseAreRefused) {
    const char* const singular = "cannot be inverted";
    expect_volume_fault(singular, [](Volumes& v) { v.records[0].to_world = {}; });
    expect_volume_fault(singular, [](Volumes& v) { v.records[0].to_world[3] = kNan; });
    expect_volume_fault(singular, [](Volumes& v) { v.records[0].to_world[0] = kInfinity; });
    expect_volume_fault(
        singular, [](Volumes& v) { v.records[0].to_world = {1, 2, 3, 0, 2, 4, 6, 0, 1, 1, 1, 0}; });
    EXPECT_EQ(structure_fault([](Volumes& v) {
                  v.records[0].to_world = {1e-12f, 0, 0, 0, 0, 1e-12f, 0, 0, 0, 0, 1e-12f, 0};
              }),
              "");
}

TEST(VolumesFile, RangesBeyondTheirArraysAreRefused) {
    const char* const ranges = "its table, bricks, corners or nodes lie outside";
    const char* const rows = "its rows or codes lie outside";
    expect_volume_fault("larger than all tables", [](Volumes& v) {
        v.records[0].extent = {1u << 21, 1u << 21, 1u << 22};  // their product is 0 in 64 bits
        v.records[0].first_brick = {};
    });
    expect_volume_fault(ranges, [](Volumes& v) { v.records[1].first_cell = 4; });
    expect_volume_fault(ranges, [](Volumes& v) { v.records[1].first_cell = UINT64_MAX; });
    expect_volume_fault(ranges, [](Volumes& v) { v.records[1].first_brick_number = 3; });
    expect_volume_fault(ranges, [](Volumes& v) { v.records[1].brick_count = 0xffffffffu; });
    expect_volume_fault(ranges, [](Volumes& v) { v.records[1].first_corner += 1; });
    expect_volume_fault(ranges, [](Volumes& v) { v.records[1].first_node += 1; });
    expect_volume_fault(ranges, [](Volumes& v) { v.records[1].node_count += 1; });
    expect_volume_fault(rows, [](Volumes& v) { v.records[1].first_row += 1; });
    expect_volume_fault(rows, [](Volumes& v) { v.records[1].first_band_row += 1; });
    expect_volume_fault(rows, [](Volumes& v) { v.records[1].first_code += 1; });
    expect_volume_fault(rows, [](Volumes& v) { v.records[1].multiple_terms = 1; });
}

// Otherwise a small file could ask for the same work any number of times.
TEST(VolumesFile, VolumesDoNotShareTheirParts) {
    const auto expect_refused = [](auto change) {
        EXPECT_THAT(structure_fault(change), HasSubstr("volume 1: its"));
        EXPECT_THAT(structure_fault(change), HasSubstr("overlap"));
    };
    expect_refused([](Volumes& v) { v.records[1] = v.records[0]; });
    expect_refused([](Volumes& v) { v.records[1].first_cell -= 1; });
    expect_refused([](Volumes& v) { v.records[1].first_brick_number -= 1; });
    expect_refused([](Volumes& v) { v.records[1].first_corner -= 1; });
    expect_refused([](Volumes& v) { v.records[1].first_node -= 1; });
    expect_refused([](Volumes& v) { v.records[1].first_row -= 1; });
    expect_refused([](Volumes& v) { v.records[1].first_band_row -= 1; });
    expect_refused([](Volumes& v) { v.records[1].first_code -= 1; });
}

TEST(VolumesFile, NumbersOfBricksNodesAndCoefficientsThatAreNotThereAreRefused) {
    EXPECT_THAT(structure_fault([](Volumes& v) { v.table[1] = 2; }),
                HasSubstr("volume 0: its table refers to a brick"));
    EXPECT_THAT(structure_fault([](Volumes& v) { v.corner[7] = v.records[0].node_count; }),
                HasSubstr("volume 0: a corner of a brick refers to a node that it does not have"));
    EXPECT_THAT(structure_fault([](Volumes& v) { v.rows.index16.back() = 384; }),
                HasSubstr("section VOLU: a coefficient index is not below 384"));
    EXPECT_THAT(structure_fault([](Volumes& v) { v.rows.row_offset[1] = 0xffffffffu; }),
                HasSubstr("section VOLU: row offsets are not ascending"));
}

TEST(VolumesFile, ArraysOfOtherSizesThanTheHeadSaysAreRefused) {
    const char* const counts = "its counts do not agree with its size";
    expect_volume_fault(counts,
                        [](Volumes& v) { v.density.resize(v.density.size() - kBrickVoxels); });
    expect_volume_fault(counts,
                        [](Volumes& v) { v.density_scale.resize(v.density_scale.size() + 64); });
    expect_volume_fault(counts, [](Volumes& v) { v.phase.resize(v.phase.size() - kPhaseEntries); });
    expect_volume_fault(counts, [](Volumes& v) { v.rows.average_scale.clear(); });
}

TEST(VolumesFile, ValuesOfRecordsOutOfRangeAreRefusedByName) {
    for (const float bad : {-1.0f, kNan, kInfinity}) {
        EXPECT_THAT(value_fault([=](Volumes& v) { v.records[1].sigma_t.g = bad; }),
                    HasSubstr("volume 1: its extinction"));
        EXPECT_THAT(value_fault([=](Volumes& v) { v.records[1].albedo.b = bad; }),
                    HasSubstr("volume 1: its albedo"));
        EXPECT_THAT(value_fault([=](Volumes& v) { v.density_scale[2] = bad; }),
                    HasSubstr("volume 1: the density of a brick"));
        EXPECT_THAT(value_fault([=](Volumes& v) { v.rows.detail_scale[3] = bad; }),
                    HasSubstr("section VOLU: a scale"));
    }
    EXPECT_THAT(value_fault([](Volumes& v) { v.records[0].albedo.r = 1.01f; }),
                HasSubstr("volume 0: its albedo"));
    EXPECT_THAT(value_fault([](Volumes& v) { v.density_scale[0] = 1e37f; }),
                HasSubstr("volume 0: the density of a brick"));
    for (const float bad : {1.1f, -1.1f, kNan}) {
        EXPECT_THAT(value_fault([=](Volumes& v) { v.records[0].moment[2] = bad; }),
                    HasSubstr("volume 0: a moment"));
    }
    EXPECT_THAT(value_fault([](Volumes& v) { v.records[0].moment[0] = 0.9f; }),
                HasSubstr("moment 0 of 0.9"));
    EXPECT_EQ(value_fault([](Volumes& v) {
                  v.records[0].single_terms = 0;
                  v.records[0].moment = {};
              }),
              "");
}

TEST(VolumesFile, PhaseFunctionsOutOfRangeAreRefusedByName) {
    for (const float bad : {-1e-6f, kNan, kInfinity}) {
        EXPECT_THAT(value_fault([=](Volumes& v) { v.phase[kPhaseEntries + 30] = bad; }),
                    HasSubstr("volume 1: its phase function is below zero or not finite"));
    }
    EXPECT_THAT(value_fault([](Volumes& v) { v.phase[128] = 1; }),
                HasSubstr("volume 0: its phase function integrates to 1.0"));
    const auto black = [](Volumes& v) { std::fill_n(v.phase.begin(), kPhaseEntries, 0.0f); };
    EXPECT_THAT(value_fault(black),
                HasSubstr("volume 0: its phase function integrates to 0.000000; expected 1"));
    // Nobody uses it where single scattering is not shown.
    EXPECT_EQ(value_fault([&](Volumes& v) {
                  black(v);
                  v.records[0].single_terms = 0;
              }),
              "");
}

TEST(VolumesFile, NodesStandAtTheCornersThatReferToThem) {
    const char* const elsewhere = "a corner of a brick refers to a node that stands elsewhere";
    EXPECT_THAT(value_fault([](Volumes& v) { v.node[3][2] += 4; }), HasSubstr(elsewhere));
    EXPECT_THAT(value_fault([](Volumes& v) { v.corner[0] = 1; }), HasSubstr(elsewhere));
    EXPECT_THAT(value_fault([](Volumes& v) { v.records[1].first_brick[0] = 7; }),
                HasSubstr(elsewhere));
    // A brick that stands in two cells has its nodes in one of them.
    EXPECT_THAT(value_fault([](Volumes& v) { v.table[1] = v.table[0]; }), HasSubstr(elsewhere));
    EXPECT_EQ(value_fault([](Volumes& v) { v.corner[0] = kNoNode; }), "");
}

TEST(VolumesFile, RowsAreAscendingDetails) {
    EXPECT_THAT(value_fault([](Volumes& v) { v.rows.index16[1] = v.rows.index16[0]; }),
                HasSubstr("section VOLU, row 0: its indices"));
    EXPECT_THAT(value_fault([](Volumes& v) { v.rows.index16[0] = 0; }),
                HasSubstr("section VOLU, row 0: its indices"));
}

}  // namespace
}  // namespace opaline::formats
