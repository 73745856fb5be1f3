// Copies have vertices of their own and the rows of their originals when a file is read, and what
// no writer may write is refused by name.
#include "formats/opal/copies.h"

#include <gmock/gmock.h>

#include <limits>

#include "formats/opal/layout.h"
#include "tests/formats/opal/hole_fixture.h"
#include "tests/formats/opal/normal_map_fixture.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/receiver_error_fixture.h"
#include "tests/formats/opal/slot_fixture.h"

namespace opaline::formats {
namespace {

constexpr Vec3 kOffset = tests::kCopyOffset;

void expect_same_rows(const RowRange& a, const RowRange& b) {
    EXPECT_EQ(a.first_row, b.first_row);
    EXPECT_EQ(a.rows, b.rows);
    EXPECT_EQ(a.first_band_row, b.first_band_row);
    EXPECT_EQ(a.first_code, b.first_code);
}

template <class T>
void expect_same(std::span<const T> array, const PrimitiveRecord& a, const PrimitiveRecord& b) {
    if (array.empty()) return;
    tests::expect_same_bytes(array.subspan(a.first_vertex, a.vertex_count),
                             array.subspan(b.first_vertex, b.vertex_count));
}

void expect_copy(const AssetView& view, std::size_t original, std::size_t copy) {
    const PrimitiveRecord &from = view.primitives[original], &to = view.primitives[copy];
    ASSERT_EQ(to.vertex_count, from.vertex_count);
    EXPECT_EQ(to.node, 77u);
    for (std::uint32_t v = 0; v < from.vertex_count; ++v) {
        const std::uint32_t a = from.first_vertex + v, b = to.first_vertex + v;
        const Vec3 at = view.position[a] + kOffset;
        EXPECT_EQ(view.position[b].x, at.x);
        EXPECT_EQ(view.position[b].y, at.y);
        EXPECT_EQ(view.position[b].z, at.z);
        EXPECT_EQ(view.slot_of(copy, b), view.slot_of(original, a));
        EXPECT_EQ(view.vertex_of(copy, view.slot_of(copy, b)) - to.first_vertex,
                  view.vertex_of(original, view.slot_of(original, a)) - from.first_vertex);
        ASSERT_EQ(view.slots.is_mixed(b), view.slots.is_mixed(a));
        for (std::size_t k = 0; k < 3 && view.slots.is_mixed(a); ++k) {
            EXPECT_EQ(view.slots.mix[b].slot[k] - view.slots.offset[copy],
                      view.slots.mix[a].slot[k] - view.slots.offset[original]);
            EXPECT_EQ(view.slots.mix[b].weight[k], view.slots.mix[a].weight[k]);
        }
    }
    expect_same_rows(view.rows_of(original), view.rows_of(copy));
    expect_same(view.normal, from, to);
    expect_same(view.base_color, from, to);
    expect_same(view.texcoord, from, to);
    expect_same(view.openness, from, to);
    expect_same(view.holes.vertex_alpha, from, to);
    expect_same(view.normal_maps.tangent, from, to);
    tests::expect_same_bytes(view.index.subspan(from.first_index, from.index_count),
                             view.index.subspan(to.first_index, to.index_count));
    EXPECT_EQ(view.added.of(original), view.added.of(copy));
}

TEST(CopiesFile, HaveTheRowsAndTheMovedVerticesOfTheirOriginals) {
    Asset refined = tests::make_small_asset();
    refined.added.count = {1, 2};
    refined.added.vertex = {
        {{0, 1, 2}, {0.5f, 0.5f}}, {{0, 1, 1}, {0.25f, 0}}, {{1, 0, 0}, {1, 0}}};
    for (const Asset& given :
         {refined, tests::make_small_asset(), tests::make_shared_asset(), tests::make_mixed_asset(),
          tests::make_hole_asset(), tests::make_normal_map_asset()}) {
        const tests::StoredAsset plain(given), stored(tests::with_two_copies(given));
        const AssetView& view = stored.view();
        const std::size_t first = given.primitives.size();
        expect_copy(view, 0, first);
        expect_copy(view, 0, first + 1);
        EXPECT_EQ(stored.version_of(kPrimSection), kCopiesVersion) << "earlier readers refuse it";
        EXPECT_EQ(count_stored_vertices(view), plain.view().receivers());
        tests::expect_same_bytes(view.position.first(given.position.size()), given.position);
    }
}

TEST(CopiesFile, ErrorsOfReceiversAreThoseOfTheirOriginals) {
    const std::vector<float> errors = tests::make_receiver_errors();
    tests::AlignedBytes file(
        tests::encode_with_errors(errors, tests::with_two_copies(tests::make_small_asset())));
    const auto loaded = read_opal(file.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded);
    const auto read = read_receiver_errors(file.bytes(), *loaded, "a.opal");
    ASSERT_TRUE(read);
    const std::uint32_t count = loaded->view.primitives[0].vertex_count;
    std::vector<float> expected = errors;
    expected.insert(expected.end(), errors.begin(), errors.begin() + count);
    expected.insert(expected.end(), errors.begin(), errors.begin() + count);
    EXPECT_EQ(*read, expected);
}

TEST(CopiesFile, WhatCannotBeIsRefusedByName) {
    const float infinity = std::numeric_limits<float>::infinity();
    const std::vector<tests::Impossible> cases{
        {[](Asset& a) { a.copies[1].original = a.copies[0].primitive; }, "a copy itself"},
        {[](Asset& a) { a.primitives[0].shading = Shading::sheet; }, "depends on the view"},
        {[](Asset& a) { a.copies[0].original = 99; }, "does not exist"},
        {[](Asset& a) { a.copies[0].primitive = 99; }, "does not exist"},
        {[](Asset& a) { std::swap(a.copies[0], a.copies[1]); }, "out of order"},
        {[](Asset& a) { a.copies[1].primitive = a.copies[0].primitive; }, "stands twice"},
        {[&](Asset& a) { a.copies[0].offset.y = infinity; }, "not finite"},
        {[](Asset& a) { a.copies[0].reserved = 1; }, "not one of this version"},
        {[](Asset& a) { a.primitives[0].vertex_count = 99; }, "outside their arrays"},
        {[](Asset& a) { a.primitives[0].first_index = 99; }, "outside their arrays"},
    };
    tests::expect_refused(tests::with_two_copies(tests::make_small_asset()), "COPY", cases);
}

// A small file must not make a reader allocate without end.
TEST(CopiesFile, AsManyCopiesAsTakeMoreMemoryThanThereMayBeAreRefused) {
    AssetView stored;
    const std::vector<PrimitiveRecord> records(3000);
    std::vector<PrimitiveRecord> primitives = records;
    std::vector<Vec3> position(20000);
    std::vector<Rgb> color(position.size());
    std::vector<std::uint32_t> index(60000);
    primitives[0].vertex_count = static_cast<std::uint32_t>(position.size());
    primitives[0].index_count = static_cast<std::uint32_t>(index.size());
    std::vector<CopyRecord> copies;
    for (std::uint32_t p = 1; p < primitives.size(); ++p) {
        copies.push_back({p, 0, {}, 0});
    }
    stored.primitives = primitives;
    stored.position = stored.normal = position;
    stored.base_color = color;
    stored.index = index;
    stored.copies = std::span(copies).first(10);
    EXPECT_EQ(find_copies_fault(stored, 1000).what, "");
    stored.copies = copies;
    EXPECT_THAT(find_copies_fault(stored, 1000).what, testing::HasSubstr("more vertices"));
    EXPECT_EQ(find_copies_fault(stored, 1u << 30).what, "") << "of a file that is as large itself";
}

}  // namespace
}  // namespace opaline::formats
