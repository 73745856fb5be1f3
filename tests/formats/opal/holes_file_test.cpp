// Holes of surfaces that are written come back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include <limits>

#include "tests/formats/opal/hole_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;
using tests::make_hole_asset;

TEST(HolesFile, WhatIsWrittenComesBackAndSurfacesWithoutAreWhole) {
    const Asset asset = make_hole_asset();
    const tests::StoredAsset stored(asset);
    const HolesView& holes = stored.view().holes;
    tests::expect_same_bytes(holes.record, asset.holes.record);
    tests::expect_same_bytes(holes.vertex_alpha, asset.holes.vertex_alpha);
    EXPECT_EQ(holes.of(1)->wrap_v, Wrap::mirror);
    EXPECT_EQ(holes.of(2), nullptr);
    EXPECT_EQ(tests::StoredAsset(tests::make_small_asset()).version_of(kHoleSection), 0u);
}

TEST(HolesFile, WhatCannotBeIsRefusedByName) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<tests::Impossible> cases{
        {[](Asset& a) { a.holes.record[1].primitive = 0; }, "stands twice"},
        {[](Asset& a) { a.holes.record[1].primitive = 2; }, "does not exist"},
        {[](Asset& a) { a.holes.record[0].mode = HoleMode{3}; }, "neither a mask nor a blend"},
        {[](Asset& a) { a.holes.record[0].mode = HoleMode{0}; }, "neither a mask nor a blend"},
        {[](Asset& a) { a.holes.record[0].alpha = 1.5f; }, "not in 0 ... 1"},
        {[](Asset& a) { a.holes.record[0].alpha = kNan; }, "not in 0 ... 1"},
        {[](Asset& a) { a.holes.record[1].cutoff = kNan; }, "not finite"},
        {[](Asset& a) { a.holes.record[1].cutoff = -1; }, "below zero"},
        {[](Asset& a) {
             store_clear_share({1.5f, 1.5f}, a.holes.record[1]);
         },
         "as glass"},
        {[](Asset& a) {
             store_clear_share({0.5f, 0.5f}, a.holes.record[1]);
         },
         "index below 1"},
        {[](Asset& a) { a.holes.record[1].image = 1; }, "not there"},
        {[](Asset& a) { a.holes.record[1].wrap_u = Wrap{3}; }, "wrap mode"},
        {[](Asset& a) { a.holes.vertex_alpha.pop_back(); }, "alpha of 7 vertices"},
        {[](Asset& a) { a.holes.vertex_alpha[3] = -0.5f; }, "not in 0 ... 1"},
        {[](Asset& a) { a.holes.vertex_alpha[3] = kNan; }, "not in 0 ... 1"},
        {[](Asset& a) {
             tests::add_translucent_triangle(a, 1, 1.3f);
             a.holes.vertex_alpha.resize(a.position.size(), 1.0f);
             a.holes.record[1].primitive = 2;
         },
         "translucent"},
    };
    tests::expect_refused(make_hole_asset(), "HOLE", cases, Checks::full);
}

}  // namespace
}  // namespace opaline::formats
