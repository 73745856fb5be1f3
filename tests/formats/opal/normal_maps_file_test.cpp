// Normal maps that are written come back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "tests/formats/opal/normal_map_fixture.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/section_damage.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;
using tests::make_normal_map_asset;

TEST(NormalMapsFile, WhatIsWrittenComesBackAndOtherSurfacesHaveNone) {
    const Asset asset = make_normal_map_asset();
    tests::AlignedBytes stored(tests::encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded);
    const NormalMapsView& maps = loaded->view.normal_maps;
    tests::expect_same_bytes(maps.record,
                             std::span<const NormalMapRecord>(asset.normal_maps.record));
    tests::expect_same_bytes(maps.tangent, std::span<const Tangent>(asset.normal_maps.tangent));
    EXPECT_EQ(maps.of(1)->wrap_v, Wrap::clamp);
    EXPECT_EQ(maps.of(0), nullptr);

    tests::AlignedBytes plain(tests::encode(tests::make_small_asset()));
    const auto table = read_section_table(plain.bytes(), "a.opal");
    ASSERT_TRUE(table);
    for (const SectionEntry& section : *table) {
        EXPECT_NE(section.id, kNormSection);
    }
}

TEST(NormalMapsFile, TangentsKeepTheirDirectionToFifteenSecondsOfArc) {
    for (int i = 0; i < 500; ++i) {
        const float z = -1 + 0.004f * static_cast<float>(i), angle = 2.4f * static_cast<float>(i);
        const float side = std::sqrt(1 - z * z);
        const Vec3 direction{side * std::cos(angle), side * std::sin(angle), z};
        const auto decoded = decode_tangent(encode_tangent(direction, i % 2 == 0 ? 1.0f : -1.0f));
        EXPECT_LT(length(cross(decoded.direction, direction)), 7.3e-5f) << i;
        EXPECT_GT(dot(decoded.direction, direction), 0.9999f);
        EXPECT_EQ(decoded.sign, i % 2 == 0 ? 1 : -1);
    }
    EXPECT_EQ(decode_tangent(encode_tangent({}, 0)).direction, Vec3{});
}

std::uint32_t version_of_maps(const Asset& asset) {
    tests::AlignedBytes stored(tests::encode(asset));
    const auto table = read_section_table(stored.bytes(), "a.opal");
    EXPECT_TRUE(table);
    return tests::section_of(*table, kNormSection).version;
}

TEST(NormalMapsFile, SharesOfThinWalledSurfacesComeBackInALaterVersion) {
    const Asset asset = tests::make_mapped_sheet_asset();
    tests::AlignedBytes stored(tests::encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
    const SheetShares shares = sheet_shares_of(loaded->view.normal_maps.record[0]);
    EXPECT_EQ(shares.reflect, (Rgb{0.5f, 0.25f, 0}));
    EXPECT_EQ(shares.transmit, (Rgb{0.25f, 0.75f, 1}));
    EXPECT_EQ(version_of_maps(asset), 2u);
    EXPECT_EQ(version_of_maps(make_normal_map_asset()), 1u);

    Asset too_much = asset, negative = asset;
    too_much.normal_maps.record[0].reserved[1] = 0x3c010000u;
    negative.normal_maps.record[0].reserved[2] = 0x8001u;
    EXPECT_THAT(tests::fault_of(too_much, Checks::structure), HasSubstr("not one of this version"));
    EXPECT_THAT(tests::fault_of(negative, Checks::structure), HasSubstr("not one of this version"));
}

TEST(NormalMapsFile, WhatCannotBeIsRefusedByName) {
    const std::pair<std::function<void(Asset&)>, const char*> cases[]{
        {[](Asset& a) { a.normal_maps.record.push_back(a.normal_maps.record[0]); }, "stands twice"},
        {[](Asset& a) { a.normal_maps.record[0].primitive = 2; }, "does not exist"},
        {[](Asset& a) { a.normal_maps.record[0].primitive = 0xffffffffu; }, "does not exist"},
        {[](Asset& a) { a.normal_maps.record[0].image = 1; }, "not there"},
        {[](Asset& a) { a.normal_maps.record[0].image = kNoImage; }, "not there"},
        {[](Asset& a) { a.normal_maps.record[0].wrap_u = Wrap{3}; }, "wrap mode"},
        {[](Asset& a) { a.normal_maps.record[0].scale = std::numeric_limits<float>::infinity(); },
         "scale"},
        {[](Asset& a) { a.normal_maps.record[0].scale = -1001; }, "scale"},
        {[](Asset& a) { a.normal_maps.record[0].reserved[2] = 1; }, "not one of this version"},
        {[](Asset& a) { a.normal_maps.tangent.pop_back(); }, "a tangent for each vertex"},
    };
    for (const auto& [damage, fault] : cases) {
        Asset asset = make_normal_map_asset();
        damage(asset);
        tests::AlignedBytes stored(tests::encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        ASSERT_FALSE(loaded) << fault;
        EXPECT_THAT(loaded.error().diagnostics.front().where, HasSubstr("section NORM"));
        EXPECT_THAT(loaded.error().diagnostics.front().fault, HasSubstr(fault));
    }
}

TEST(NormalMapsFile, DamagedBytesAreFound) {
    tests::expect_flipped_bytes_found(make_normal_map_asset(), kNormSection);
    tests::expect_truncations_refused(make_normal_map_asset());
}

}  // namespace
}  // namespace opaline::formats
