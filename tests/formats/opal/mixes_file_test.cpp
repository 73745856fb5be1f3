// Vertices without rows of their own come back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include "formats/opal/layout.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/slot_fixture.h"

namespace opaline::formats {
namespace {

TEST(MixesFile, WhatIsWrittenComesBack) {
    const Asset asset = tests::make_mixed_asset();
    const tests::StoredAsset stored(asset);
    const AssetView& view = stored.view();
    tests::expect_same_bytes(view.slots.offset, asset.slots.offset);
    tests::expect_same_bytes(view.slots.slot, asset.slots.slot);
    tests::expect_same_bytes(view.slots.vertex, asset.slots.vertex);
    tests::expect_same_bytes(view.slots.mix, asset.slots.mix);
    tests::expect_same_bytes(view.slots.place, asset.slots.place);
    tests::expect_same_bytes(view.position, asset.position);
    tests::expect_same_bytes(view.normal, asset.normal);
    tests::expect_same_bytes(view.index, asset.index);
    EXPECT_EQ(stored.version_of(kMixrSection), 1u);
    EXPECT_EQ(stored.version_of(kPrimSection), kMixedVersion) << "earlier readers refuse it";
    EXPECT_EQ(view.slot_count(0), 4u) << "rows of its own vertices alone";
    EXPECT_TRUE(view.slots.is_mixed(4));
    EXPECT_FALSE(view.slots.is_mixed(3));
}

TEST(MixesFile, WhatCannotBeIsRefusedByName) {
    constexpr const char* kNoMix = "primitive 0: a vertex is mixed of slots that are not there";
    const auto with = [](SlotMix mix) { return [=](Asset& a) { a.slots.mix[4] = mix; }; };
    const std::vector<tests::Impossible> cases{
        {with({{0, 1, 4}, {120, 100, 35, 0}}), kNoMix},  // the next primitive's
        {with({{0, 1, 0xfffffff0u}, {120, 100, 35, 0}}), kNoMix},
        {with({{0, 1, 2}, {120, 100, 36, 0}}), kNoMix},
        {with({{0, 1, 2}, {120, 100, 34, 0}}), kNoMix},
        {with({{0, 1, 2}, {100, 120, 35, 0}}), kNoMix},
        {with({{0, 1, 2}, {0, 255, 0, 0}}), kNoMix},
        {with({{0, 1, 2}, {120, 100, 35, 1}}), kNoMix},
        {[](Asset& a) {
             a.slots.mix[3] = {{0, 1, 2}, {120, 100, 35, 0}};
         },
         "mixed of slots"},
        {[](Asset& a) { a.primitives[0].shading = Shading::sheet; }, "depends on the view"},
    };
    tests::expect_refused(tests::make_mixed_asset(), "MIXR", cases);
}

// Without one of both, rows would be taken for those of other vertices.
TEST(MixesFile, GoWithSharAndAVersionOfPrimitivesOfTheirOwn) {
    const auto fault_with = [](const Asset& asset, std::uint32_t id, auto&& change) {
        tests::AlignedBytes stored(tests::encode(asset));
        auto table = *read_section_table(stored.bytes(), "a.opal");
        change(table[static_cast<std::size_t>(&tests::section_of(table, id) - table.data())]);
        std::memcpy(stored.bytes().data() + sizeof(FileHeader), table.data(),
                    table.size() * sizeof table[0]);
        tests::repair_checksums(stored.bytes(), 0);
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::sizes);
        return loaded ? "" : loaded.error().diagnostics.front().fault;
    };
    const auto rename = [](SectionEntry& entry) { entry.id = section_id("ELSE"); };
    const auto as = [](std::uint32_t version) {
        return [=](SectionEntry& entry) { entry.version = version; };
    };
    const Asset mixed = tests::make_mixed_asset();
    EXPECT_EQ(fault_with(mixed, kPrimSection, as(kMixedVersion)), "");
    for (const std::string& fault :
         {fault_with(mixed, kPrimSection, as(kSlotsVersion)),
          fault_with(mixed, kMixrSection, rename), fault_with(mixed, kSharSection, rename),
          fault_with(tests::make_small_asset(), kPrimSection, as(kMixedVersion))}) {
        EXPECT_THAT(fault, testing::HasSubstr("do not go together"));
    }
}

}  // namespace
}  // namespace opaline::formats
