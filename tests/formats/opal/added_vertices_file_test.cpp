// Vertices that a baker added are written with where they lie, and what cannot be is refused.
#include <gmock/gmock.h>

#include <limits>

#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::formats {
namespace {

// The last vertex of the first primitive, and the last two of the second.
Asset make_refined_asset() {
    Asset asset = tests::make_small_asset();
    asset.added.count = {1, 2};
    asset.added.vertex = {{{0, 1, 2}, {0.5f, 0.5f}}, {{0, 1, 1}, {0.25f, 0}}, {{1, 0, 0}, {1, 0}}};
    return asset;
}

TEST(AddedVerticesFile, WhatIsWrittenComesBackAndOtherFilesHaveNone) {
    const Asset asset = make_refined_asset();
    const tests::StoredAsset stored(asset);
    tests::expect_same_bytes(stored.view().added.count, asset.added.count);
    tests::expect_same_bytes(stored.view().added.vertex, asset.added.vertex);
    EXPECT_EQ(stored.view().added.of(1), 2u);
    EXPECT_EQ(stored.version_of(kRefiSection), 1u);
    const tests::StoredAsset plain(tests::make_small_asset());
    EXPECT_EQ(plain.version_of(kRefiSection), 0u);
    EXPECT_EQ(plain.view().added.of(1), 0u);
}

TEST(AddedVerticesFile, WhatCannotBeIsRefusedByName) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::vector<tests::Impossible> cases{
        {[](Asset& a) { a.added.count.pop_back(); }, "a number for each primitive"},
        {[](Asset& a) { a.added.count[1] = 3; }, "more vertices were added"},
        {[](Asset& a) {
             a.added.count = {5, 0};
         },
         "more vertices were added"},
        {[](Asset& a) { a.added.count[0] = 0xffffffffu; }, "more vertices were added"},
        {[](Asset& a) { a.added.count[1] = 1; }, "belong to no primitive"},
        {[](Asset& a) { a.added.vertex[0].corner[2] = 3; }, "does not have"},
        {[](Asset& a) { a.added.vertex[2].corner[0] = 2; }, "does not have"},
        {[](Asset& a) { a.added.vertex[0].corner[0] = 0xffffffffu; }, "does not have"},
        {[](Asset& a) {
             a.added.vertex[0].weight = {0.75f, 0.5f};
         },
         "not those of a point"},
        {[](Asset& a) { a.added.vertex[0].weight[0] = -0.25f; }, "not those of a point"},
        {[nan](Asset& a) { a.added.vertex[1].weight[1] = nan; }, "not those of a point"}};
    tests::expect_refused(make_refined_asset(), "REFI", cases, Checks::full);
}

}  // namespace
}  // namespace opaline::formats
