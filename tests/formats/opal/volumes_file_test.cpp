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
using tests::AlignedBytes;
using tests::encode;
using tests::expect_same_bytes;

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
    EXPECT_EQ(a.rows.cubemap_size, b.rows.cubemap_size);
    EXPECT_EQ(a.rows.code_bits, b.rows.code_bits);
    expect_same_bytes(a.rows.row_offset, b.rows.row_offset);
    expect_same_bytes(a.rows.average_scale, b.rows.average_scale);
    expect_same_bytes(a.rows.detail_scale, b.rows.detail_scale);
    expect_same_bytes(a.rows.average_code, b.rows.average_code);
    expect_same_bytes(a.rows.index16, b.rows.index16);
    expect_same_bytes(a.rows.index32, b.rows.index32);
    expect_same_bytes(a.rows.code8, b.rows.code8);
    expect_same_bytes(a.rows.code16, b.rows.code16);
}

TEST(VolumesFile, ReturnsEveryValueItWasGivenWithoutAnyPrimitive) {
    for (const std::uint32_t bits : {8u, 16u}) {
        const Asset asset = tests::make_volume_asset(bits);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
        const AssetView& view = loaded->view;
        EXPECT_EQ(view.cubemap_size, 8u);
        EXPECT_TRUE(view.primitives.empty() && view.position.empty() && view.index.empty());
        EXPECT_EQ(view.transport.rows(), 0u);
        expect_same_volumes(view.volumes, asset.volumes.view());
        EXPECT_EQ(loaded->sections.back().id, kVoluSection);
        EXPECT_EQ(loaded->sections.back().version, 1u);
    }
}

TEST(VolumesFile, StandsBesidePrimitivesAndIsAbsentWithoutVolumes) {
    Asset asset = tests::make_small_asset();
    const std::vector<std::byte> without = encode(asset);
    tests::add_volume(asset, {.single_terms = 0, .multiple_terms = 9});
    tests::add_volume(asset, {.spacing = 8, .single_terms = 0, .multiple_terms = 0});
    tests::add_volume(asset, {.spacing = 1, .single_terms = 25, .multiple_terms = 0});
    AlignedBytes stored(encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
    expect_same_volumes(loaded->view.volumes, asset.volumes.view());
    EXPECT_EQ(loaded->view.primitives.size(), 2u);

    AlignedBytes plain(without);
    const auto surface = read_opal(plain.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(surface);
    EXPECT_TRUE(surface->view.volumes.empty());
    EXPECT_EQ(surface->sections.size() + 1, loaded->sections.size());
    EXPECT_TRUE(std::none_of(surface->sections.begin(), surface->sections.end(),
                             [](const SectionEntry& s) { return s.id == kVoluSection; }));
}

TEST(VolumesFile, RowsOfLargeCubeMapsHaveFourByteIndices) {
    Asset asset;
    asset.transport = make_sparse_rows(128, 8);
    tests::add_volume(asset, {.spacing = 8, .multiple_terms = 0, .bricks_along_x = 1});
    AlignedBytes stored(encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
    EXPECT_GT(loaded->view.volumes.rows.index32.size(), 0u);
    expect_same_volumes(loaded->view.volumes, asset.volumes.view());
}

TEST(VolumesFile, IsUsedInPlace) {
    AlignedBytes stored(encode(tests::make_volume_asset()));
    const auto loaded = read_opal(stored.bytes(), "a.opal");
    ASSERT_TRUE(loaded);
    const auto expect_inside = [&](auto span) {
        const auto* at = reinterpret_cast<const std::byte*>(span.data());
        EXPECT_GE(at, stored.bytes().data());
        EXPECT_LE(at + span.size_bytes(), stored.bytes().data() + stored.bytes().size());
    };
    expect_inside(loaded->view.volumes.records);
    expect_inside(loaded->view.volumes.density);
    expect_inside(loaded->view.volumes.corner);
    expect_inside(loaded->view.volumes.phase);
    expect_inside(loaded->view.volumes.rows.code8);
}

TEST(VolumesFile, SizeIsKnownBeforeItIsWritten) {
    const Asset asset = tests::make_volume_asset();
    EXPECT_EQ(opal_size(asset.view()), encode(asset).size());
}

// The fault of the asset of the fixture after a change, under the checks given.
template <class Change>
std::string fault_of(Checks checks, Change change) {
    Asset asset = tests::make_volume_asset();
    change(asset.volumes);
    return tests::fault_of(asset, checks);
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
    const auto expect_refused = [](auto change) {
        EXPECT_THAT(structure_fault(change), HasSubstr("cannot be inverted"));
    };
    expect_refused([](Volumes& v) { v.records[0].to_world = {}; });
    expect_refused([](Volumes& v) { v.records[0].to_world[3] = kNan; });
    expect_refused([](Volumes& v) { v.records[0].to_world[0] = kInfinity; });
    expect_refused(
        [](Volumes& v) { v.records[0].to_world = {1, 2, 3, 0, 2, 4, 6, 0, 1, 1, 1, 0}; });
    EXPECT_EQ(structure_fault([](Volumes& v) {
                  v.records[0].to_world = {1e-12f, 0, 0, 0, 0, 1e-12f, 0, 0, 0, 0, 1e-12f, 0};
              }),
              "");
}

TEST(VolumesFile, RangesBeyondTheirArraysAreRefused) {
    const auto expect_refused = [](const char* what, auto change) {
        EXPECT_THAT(structure_fault(change), HasSubstr(what));
    };
    const char* const ranges = "its table, bricks, corners or nodes lie outside";
    const char* const rows = "its rows or codes lie outside";
    expect_refused("larger than all tables", [](Volumes& v) {
        v.records[0].extent = {1u << 21, 1u << 21, 1u << 22};  // their product is 0 in 64 bits
        v.records[0].first_brick = {};
    });
    expect_refused(ranges, [](Volumes& v) { v.records[1].first_cell = 4; });
    expect_refused(ranges, [](Volumes& v) { v.records[1].first_cell = UINT64_MAX; });
    expect_refused(ranges, [](Volumes& v) { v.records[1].first_brick_number = 3; });
    expect_refused(ranges, [](Volumes& v) { v.records[1].brick_count = 0xffffffffu; });
    expect_refused(ranges, [](Volumes& v) { v.records[1].first_corner += 1; });
    expect_refused(ranges, [](Volumes& v) { v.records[1].first_node += 1; });
    expect_refused(ranges, [](Volumes& v) { v.records[1].node_count += 1; });
    expect_refused(rows, [](Volumes& v) { v.records[1].first_row += 1; });
    expect_refused(rows, [](Volumes& v) { v.records[1].first_band_row += 1; });
    expect_refused(rows, [](Volumes& v) { v.records[1].first_code += 1; });
    expect_refused(rows, [](Volumes& v) { v.records[1].multiple_terms = 1; });
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
    const auto expect_refused = [](auto change) {
        EXPECT_THAT(structure_fault(change), HasSubstr("its counts do not agree with its size"));
    };
    expect_refused([](Volumes& v) { v.density.resize(v.density.size() - kBrickVoxels); });
    expect_refused([](Volumes& v) { v.density_scale.resize(v.density_scale.size() + 64); });
    expect_refused([](Volumes& v) { v.phase.resize(v.phase.size() - kPhaseEntries); });
    expect_refused([](Volumes& v) { v.rows.average_scale.clear(); });
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
