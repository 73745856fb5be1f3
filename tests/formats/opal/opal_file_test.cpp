// What is written comes back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::formats {
namespace {

using tests::AlignedBytes;
using tests::encode;

template <class A, class B>
void expect_same_bytes(const A& a, const B& b) {
    ASSERT_EQ(std::size(a), std::size(b));
    if (std::size(a) > 0) {
        EXPECT_EQ(std::memcmp(std::data(a), std::data(b), std::size(a) * sizeof(*std::data(a))), 0);
    }
}

TEST(OpalFile, ReturnsEveryValueItWasGiven) {
    for (const std::uint32_t bits : {8u, 16u}) {
        const Asset asset = tests::make_small_asset(bits);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
        const AssetView& view = loaded->view;
        EXPECT_EQ(view.provenance, asset.provenance);
        EXPECT_EQ(view.cubemap_size, 8u);
        expect_same_bytes(view.primitives, asset.primitives);
        expect_same_bytes(view.position, asset.position);
        expect_same_bytes(view.normal, asset.normal);
        expect_same_bytes(view.base_color, asset.base_color);
        expect_same_bytes(view.texcoord, asset.texcoord);
        expect_same_bytes(view.index, asset.index);
        expect_same_bytes(view.transport.row_offset, asset.transport.row_offset);
        expect_same_bytes(view.transport.average_scale, asset.transport.average_scale);
        expect_same_bytes(view.transport.detail_scale, asset.transport.detail_scale);
        expect_same_bytes(view.transport.average_code, asset.transport.average_code);
        expect_same_bytes(view.transport.index16, asset.transport.index16);
        expect_same_bytes(view.transport.code8, asset.transport.code8);
        expect_same_bytes(view.transport.code16, asset.transport.code16);
        ASSERT_EQ(view.images.size(), 1u);
        expect_same_bytes(view.images[0].rgb, asset.images[0].rgb);
        for (const SectionEntry& section : loaded->sections) {
            EXPECT_EQ(section.offset % kSectionAlignment, 0u);
        }
    }
}

TEST(OpalFile, TranslucentPrimitivesComeBackWithEveryTerm) {
    for (const std::uint32_t terms : {1u, 4u, 9u, 16u, 25u}) {
        for (const float eta : {kMinEta, 1.0f, 1.3f, kMaxEta}) {
            Asset asset = tests::make_small_asset();
            tests::add_translucent_triangle(asset, terms, eta);
            AlignedBytes stored(encode(asset));
            const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
            ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
            ASSERT_EQ(loaded->view.primitives.size(), 3u);
            const PrimitiveRecord& p = loaded->view.primitives[2];
            expect_same_bytes(loaded->view.primitives, asset.primitives);
            ASSERT_EQ(p.rows().rows, 3 * terms);
            std::vector<float> stored_row(cubemap_texels(8)), own_row(cubemap_texels(8));
            for (std::uint32_t row = 0; row < p.rows().rows; ++row) {
                decode_row(loaded->view.transport, p.rows(), row, 1, stored_row);
                decode_row(asset.transport.view(), p.rows(), row, 1, own_row);
                EXPECT_EQ(stored_row, own_row);
            }
        }
    }
}

std::uint32_t version_of_primitives(const LoadedAsset& loaded) {
    return std::find_if(loaded.sections.begin(), loaded.sections.end(),
                        [](const SectionEntry& s) { return s.id == kPrimSection; })
        ->version;
}

// Readers that expect three bands in media must not take such a file for a damaged one.
TEST(OpalFile, MediaOfOneBandComeBackUnderAVersionOfTheirOwn) {
    for (const bool is_separate : {false, true}) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, is_separate ? 5 : 4, 1.3f, is_separate, 1);
        tests::add_translucent_triangle(asset, 4, 1.4f, false, 3);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
        EXPECT_EQ(version_of_primitives(*loaded), 2u);
        expect_same_bytes(loaded->view.primitives, asset.primitives);
        EXPECT_EQ(loaded->view.primitives[2].bands, 1u);
        std::vector<float> stored_row(cubemap_texels(8)), own_row(cubemap_texels(8));
        for (const std::size_t p : {2u, 3u}) {
            const RowRange range = asset.primitives[p].rows();
            decode_row(loaded->view.transport, range, range.rows - 1, 0, stored_row);
            decode_row(asset.transport.view(), range, range.rows - 1, 0, own_row);
            EXPECT_EQ(stored_row, own_row);
        }
    }
}

TEST(OpalFile, WithoutMediaOfOneBandEarlierReadersReadIt) {
    Asset asset = tests::make_small_asset();  // one diffuse primitive of one band
    tests::add_translucent_triangle(asset, 4, 1.3f);
    AlignedBytes stored(encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal");
    ASSERT_TRUE(loaded);
    EXPECT_EQ(version_of_primitives(*loaded), 1u);
}

TEST(OpalFile, ImpossibleShadingIsRefusedByName) {
    const auto fault_of = [](auto change) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, 4, 1.3f);
        change(asset.primitives);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        return loaded ? std::string() : loaded.error().diagnostics.front().fault;
    };
    using Primitives = std::vector<PrimitiveRecord>;
    EXPECT_EQ(fault_of([](Primitives&) {}), "");
    for (const std::uint32_t terms : {0u, 2u, 3u, 5u, 36u, 0xffffffffu}) {
        EXPECT_THAT(fault_of([terms](Primitives& p) { p[2].terms = terms; }),
                    testing::HasSubstr("terms"));
    }
    for (const std::uint32_t bands : {0u, 2u, 4u, 0xffffffffu}) {
        EXPECT_THAT(
            fault_of([bands](Primitives& p) { p[2].bands = bands; }),
            testing::AllOf(testing::HasSubstr(std::to_string(bands) + " bands"),
                           testing::HasSubstr("expected"), testing::HasSubstr("1 or 3 bands")));
    }
    for (const float eta : {0.0f, 0.33f, 3.01f, -1.3f, std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::infinity()}) {
        EXPECT_THAT(fault_of([eta](Primitives& p) { p[2].eta = eta; }),
                    testing::HasSubstr("index of refraction"));
        if (eta != 0) {
            EXPECT_THAT(fault_of([eta](Primitives& p) { p[0].eta = eta; }),
                        testing::HasSubstr("index of refraction"));
        }
    }
    EXPECT_THAT(fault_of([](Primitives& p) { p[0].terms = 4; }), testing::HasSubstr("terms"));
    EXPECT_THAT(fault_of([](Primitives& p) { p[1].shading = static_cast<Shading>(4); }),
                testing::HasSubstr("shading 4"));
    // More rows than there are, by the number of terms.
    EXPECT_NE(fault_of([](Primitives& p) { p[2].terms = 9; }), "");
}

TEST(OpalFile, ThinWalledSurfacesHaveARowForEachSideAndASectionVersionOfTheirOwn) {
    const auto fault_of = [](auto edit) {
        Asset asset = tests::make_small_asset();
        tests::add_sheet_triangle(asset);
        edit(asset.primitives.back());
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        return loaded ? std::string() : loaded.error().diagnostics.front().fault;
    };
    EXPECT_EQ(fault_of([](PrimitiveRecord&) {}), "");
    EXPECT_THAT(fault_of([](PrimitiveRecord& p) { p.terms = 1; }),
                testing::HasSubstr("thin-walled shading with 1 terms"));
    EXPECT_THAT(fault_of([](PrimitiveRecord& p) { p.eta = 1.3f; }),
                testing::HasSubstr("index of refraction 1.3"));
    EXPECT_THAT(fault_of([](PrimitiveRecord& p) { p.bands = 2; }), testing::HasSubstr("2 bands"));
    EXPECT_THAT(fault_of([](PrimitiveRecord& p) { p.flags = PrimitiveRecord::kSeparate; }),
                testing::HasSubstr("separate scattering"));
    Asset asset = tests::make_small_asset();
    tests::add_sheet_triangle(asset, 1);
    AlignedBytes stored(encode(asset));
    const auto view = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->view.primitives[2].shading, Shading::sheet);
    EXPECT_EQ(version_of_primitives(*view), 4u);
}

TEST(OpalFile, SeparateScatteringHasOneRowMoreThanItsHarmonics) {
    const auto fault_of = [](std::uint32_t terms, bool is_separate) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, terms, 1.3f, is_separate);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        if (loaded) {
            EXPECT_EQ(loaded->view.primitives[2].is_separate(), is_separate);
        }
        return loaded ? std::string() : loaded.error().diagnostics.front().fault;
    };
    for (const std::uint32_t single : {0u, 1u, 4u, 9u, 16u, 25u}) {
        EXPECT_EQ(fault_of(1 + single, true), "") << single;
    }
    for (const std::uint32_t terms : {3u, 4u, 6u, 9u, 25u, 27u}) {
        EXPECT_THAT(fault_of(terms, true), testing::HasSubstr("terms"));
    }
    EXPECT_NE(fault_of(26, false), "");
    Asset asset = tests::make_small_asset();
    asset.primitives[0].flags |= PrimitiveRecord::kSeparate;
    AlignedBytes stored(encode(asset));
    EXPECT_FALSE(read_opal(stored.bytes(), "a.opal"));
}

TEST(OpalFile, SingleScatteringAloneRaisesTheVersionOfPrimitives) {
    Asset asset = tests::make_small_asset();
    tests::add_translucent_triangle(asset, 4, 1.3f);
    asset.primitives[2].flags |= PrimitiveRecord::kSingleOnly;
    AlignedBytes stored(encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded);
    EXPECT_TRUE(loaded->view.primitives[2].is_single_only());
    EXPECT_EQ(version_of_primitives(*loaded), 3u);
    asset.primitives[0].flags |= PrimitiveRecord::kSingleOnly;  // opaque
    AlignedBytes opaque(encode(asset));
    EXPECT_FALSE(read_opal(opaque.bytes(), "a.opal"));
    asset.primitives[0].flags = 0;
    asset.primitives[2].flags |= PrimitiveRecord::kSeparate;
    AlignedBytes both(encode(asset));
    EXPECT_FALSE(read_opal(both.bytes(), "a.opal"));
}

TEST(OpalFile, SpecularComesBackAndIsAbsentWithoutIt) {
    Asset asset = tests::make_small_asset();
    tests::add_translucent_triangle(asset, 4, 1.3f);
    {
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
        ASSERT_TRUE(loaded);
        EXPECT_TRUE(loaded->view.roughness.empty() && loaded->view.openness.empty());
        EXPECT_EQ(loaded->sections.size(), 6u);
    }
    tests::add_gloss(asset);
    AlignedBytes stored(encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
    expect_same_bytes(loaded->view.roughness, asset.roughness);
    expect_same_bytes(loaded->view.openness, asset.openness);
    EXPECT_EQ(loaded->sections.back().id, kSpecSection);
}

TEST(OpalFile, ImpossibleSpecularIsRefusedByName) {
    const auto fault_of = [](auto change) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, 4, 1.3f);
        tests::add_gloss(asset);
        change(asset);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        return loaded ? std::string() : loaded.error().diagnostics.front().where;
    };
    EXPECT_EQ(fault_of([](Asset&) {}), "");
    for (const float roughness : {-0.5f, 1.01f, std::numeric_limits<float>::quiet_NaN(),
                                  std::numeric_limits<float>::infinity()}) {
        EXPECT_EQ(fault_of([roughness](Asset& a) { a.roughness[2] = roughness; }),
                  "section SPEC, primitive 2");
    }
    EXPECT_EQ(fault_of([](Asset& a) { a.roughness[0] = 0.2f; }), "section SPEC, primitive 0");
    EXPECT_EQ(fault_of([](Asset& a) { a.roughness.pop_back(); }), "section SPEC");
    EXPECT_EQ(fault_of([](Asset& a) { a.openness.pop_back(); }), "section SPEC");
}

TEST(OpalFile, GlossComesBack) {
    Asset asset = tests::make_small_asset();
    tests::add_translucent_triangle(asset, 4, 1.3f);
    tests::add_opaque_gloss(asset);
    AlignedBytes stored(encode(asset));
    const auto loaded = read_opal(stored.bytes(), "a.opal", Checks::full);
    ASSERT_TRUE(loaded) << loaded.error().diagnostics.front().fault;
    expect_same_bytes(loaded->view.gloss, asset.gloss);
    EXPECT_EQ(loaded->sections.back().id, kGlosSection);
    EXPECT_EQ(loaded->sections.back().version, 1u);
}

TEST(OpalFile, ImpossibleGlossIsRefusedByName) {
    const auto fault_of = [](auto change) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, 4, 1.3f);
        tests::add_opaque_gloss(asset);
        change(asset);
        AlignedBytes stored(encode(asset));
        const auto loaded = read_opal(stored.bytes(), "a.opal");
        return loaded ? std::string() : loaded.error().diagnostics.front().where;
    };
    EXPECT_EQ(fault_of([](Asset&) {}), "");
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {-0.5f, 1.01f, nan, std::numeric_limits<float>::infinity()}) {
        EXPECT_EQ(fault_of([bad](Asset& a) { a.gloss[1].roughness = bad; }),
                  "section GLOS, primitive 1");
        EXPECT_EQ(fault_of([bad](Asset& a) { a.gloss[1].metallic = bad; }),
                  "section GLOS, primitive 1");
        EXPECT_EQ(fault_of([bad](Asset& a) { a.gloss[0].f0.g = bad; }),
                  "section GLOS, primitive 0");
        EXPECT_EQ(fault_of([bad](Asset& a) { a.gloss[0].f90 = bad; }), "section GLOS, primitive 0");
    }
    EXPECT_EQ(fault_of([](Asset& a) { a.gloss[2].roughness = 0.2f; }),
              "section GLOS, primitive 2");  // translucent
    EXPECT_EQ(fault_of([](Asset& a) { a.gloss[0].image = 1; }), "section GLOS, primitive 0");
    EXPECT_EQ(fault_of([](Asset& a) { a.gloss[0].wrap_u = static_cast<Wrap>(3); }),
              "section GLOS, primitive 0");
    EXPECT_EQ(fault_of([](Asset& a) { a.gloss.pop_back(); }), "section GLOS");
    EXPECT_EQ(fault_of([](Asset& a) { a.roughness.clear(), a.openness.clear(); }), "section GLOS");
}

TEST(OpalFile, TransportIsUsedInPlace) {
    AlignedBytes stored(encode(tests::make_small_asset()));
    const auto loaded = read_opal(stored.bytes(), "a.opal");
    ASSERT_TRUE(loaded);
    const auto* codes = reinterpret_cast<const std::byte*>(loaded->view.transport.code8.data());
    EXPECT_GE(codes, stored.bytes().data());
    EXPECT_LT(codes, stored.bytes().data() + stored.bytes().size());
}

}  // namespace
}  // namespace opaline::formats
