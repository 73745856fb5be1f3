// Vertices that share rows come back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include "formats/opal/layout.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/slot_fixture.h"

namespace opaline::formats {
namespace {

TEST(SlotsFile, WhatIsWrittenComesBackAndOtherFilesHaveASlotForEachVertex) {
    const Asset asset = tests::make_shared_asset();
    const tests::StoredAsset stored(asset);
    const AssetView& view = stored.view();
    tests::expect_same_bytes(view.slots.offset, asset.slots.offset);
    tests::expect_same_bytes(view.slots.slot, asset.slots.slot);
    tests::expect_same_bytes(view.slots.vertex, asset.slots.vertex);
    EXPECT_EQ(stored.version_of(kSharSection), 1u);
    EXPECT_EQ(stored.version_of(kPrimSection), kSlotsVersion) << "earlier readers refuse it";
    EXPECT_EQ(view.receivers(), 4 + 6 + 4 + 6 + 3 + 3u);
    EXPECT_EQ(view.slot_count(1), 4u);
    EXPECT_EQ(view.rows_of(2).rows, 12u);
    const std::uint32_t second = view.primitives[1].first_vertex;
    EXPECT_EQ(view.slot_of(1, second + 4 + 3), 1u) << "the fourth corner is vertex 1";
    EXPECT_EQ(view.vertex_of(1, 1), second + 1);

    const tests::StoredAsset plain(tests::make_small_asset());
    EXPECT_EQ(plain.version_of(kSharSection), 0u);
    EXPECT_EQ(plain.version_of(kPrimSection), 1u);
    EXPECT_EQ(plain.view().slot_of(1, 6), 2u);
    EXPECT_EQ(plain.view().vertex_of(1, 2), 6u);
    EXPECT_EQ(plain.view().slot_count(1), 4u);
}

TEST(SlotsFile, PlacesOfAWeldedMeshAreStoredOnce) {
    Asset asset = tests::make_small_asset();
    tests::add_gloss(asset);
    const Asset copied = tests::with_copied_corners(asset);
    const tests::StoredAsset welded(asset), stored(copied);
    tests::expect_same_bytes(stored.view().position, copied.position);
    tests::expect_same_bytes(stored.view().normal, copied.normal);
    tests::expect_same_bytes(stored.view().openness, copied.openness);
    tests::expect_same_bytes(stored.view().index, copied.index);
    EXPECT_EQ(stored.version_of(kSpecSection), kSlotsSpecularVersion);
    EXPECT_EQ(stored.version_of(kMeshSection), kSlotsMeshVersion);
    const auto size_of = [](const tests::StoredAsset& file) {
        return tests::section_of(file.loaded->sections, kSpecSection).size;
    };
    EXPECT_EQ(size_of(stored), size_of(welded));
}

TEST(SlotsFile, WhatCannotBeIsRefusedByName) {
    constexpr const char* kNoSlot = "more slots than there are, or one of another primitive";
    const std::vector<tests::Impossible> cases{
        {[](Asset& a) { a.slots.slot.pop_back(); }, "not those of MESH"},
        {[](Asset& a) { a.slots.slot.push_back(0); }, "not those of MESH"},
        {[](Asset& a) { a.slots.vertex.pop_back(); }, kNoSlot},
        {[](Asset& a) { a.slots.vertex.push_back(0); }, "of no primitive"},
        {[](Asset& a) { a.slots.slot[4] = 4; }, kNoSlot},
        {[](Asset& a) { a.slots.slot[4] = 0xffffffffu; }, kNoSlot},
        {[](Asset& a) { a.slots.slot[14] = 3; }, "primitive 1: it has more slots"},
        {[](Asset& a) { a.primitives[1].first_vertex = 9; }, "primitive 1: its vertices do not"},
        {[](Asset& a) { std::swap(a.primitives[0], a.primitives[1]); }, "primitive 0: its vert"},
        {[](Asset& a) { a.primitives[2].vertex_count = 0xffffffffu; }, "primitive 2: its vert"},
        {[](Asset& a) { a.primitives.pop_back(); }, "of no primitive"},
    };
    tests::expect_refused(tests::make_shared_asset(), "SHAR", cases);
}

TEST(SlotsFile, RowsAndLightOfEmittersAreThoseOfSlots) {
    const Asset asset = tests::make_shared_asset();
    tests::expect_refused(
        asset, "PRIM",
        {{[](Asset& a) { a.primitives[0].first_row = a.transport.view().rows() - 3; },
          "lie outside their arrays"}});
    tests::expect_refused(asset, "EMIT",
                          {{[](Asset& a) { a.emitters.value.resize(a.emitters.value.size() - 3); },
                            "lie outside their array"}});
}

// Either alone would be misread: by readers of one row a vertex, or for want of slots.
TEST(SlotsFile, GoWithAVersionOfPrimitivesOfTheirOwn) {
    const auto fault_with = [](const Asset& asset, std::uint32_t version) {
        tests::AlignedBytes stored(tests::encode(asset));
        auto table = *read_section_table(stored.bytes(), "a.opal");
        const auto i =
            static_cast<std::size_t>(&tests::section_of(table, kPrimSection) - table.data());
        table[i].version = version;
        std::memcpy(stored.bytes().data() + sizeof(FileHeader), table.data(),
                    table.size() * sizeof table[0]);
        tests::repair_checksums(stored.bytes(), 0);
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::sizes);
        return loaded ? "" : loaded.error().diagnostics.front().fault;
    };
    EXPECT_EQ(fault_with(tests::make_shared_asset(), kSlotsVersion), "");
    EXPECT_THAT(fault_with(tests::make_shared_asset(), kSheetVersion),
                testing::HasSubstr("do not go together"));
    EXPECT_THAT(fault_with(tests::make_small_asset(), kSlotsVersion),
                testing::HasSubstr("do not go together"));
}

}  // namespace
}  // namespace opaline::formats
