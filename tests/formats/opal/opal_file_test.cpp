// What is written comes back, and what no writer may write is refused by name.
#include <gmock/gmock.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/formats/opal/asset_fixture.h"
#include "tests/formats/opal/opal_bytes.h"

namespace opaline::formats {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using tests::expect_same_bytes;
using tests::StoredAsset;

constexpr float kUndefined = std::numeric_limits<float>::quiet_NaN();
constexpr float kUnbounded = std::numeric_limits<float>::infinity();

TEST(OpalFile, ReturnsEveryValueInPlace) {
    for (const std::uint32_t bits : {8u, 16u}) {
        const Asset asset = tests::make_small_asset(bits);
        StoredAsset stored(asset);
        const AssetView& view = stored.view();
        EXPECT_EQ(view.provenance, asset.provenance);
        EXPECT_EQ(view.cubemap_size, 8u);
        expect_same_bytes(view.primitives, asset.primitives);
        expect_same_bytes(view.position, asset.position);
        expect_same_bytes(view.normal, asset.normal);
        expect_same_bytes(view.base_color, asset.base_color);
        expect_same_bytes(view.texcoord, asset.texcoord);
        expect_same_bytes(view.index, asset.index);
        tests::expect_same_rows(view.transport, asset.transport.view());
        ASSERT_EQ(view.images.size(), 1u);
        expect_same_bytes(view.images[0].rgb, asset.images[0].rgb);
        for (const SectionEntry& section : stored.loaded->sections) {
            EXPECT_EQ(section.offset % kSectionAlignment, 0u);
        }
        EXPECT_TRUE(stored.holds(view.transport.code8) || bits == 16);
    }
}

TEST(OpalFile, TranslucentPrimitivesComeBackWithEveryTerm) {
    for (const std::uint32_t terms : {1u, 4u, 9u, 16u, 25u}) {
        for (const float eta : {kMinEta, 1.0f, 1.3f, kMaxEta}) {
            Asset asset = tests::make_small_asset();
            tests::add_translucent_triangle(asset, terms, eta);
            const StoredAsset stored(asset);
            expect_same_bytes(stored.view().primitives, asset.primitives);
            tests::expect_same_rows(stored.view().transport, asset.transport.view());
            EXPECT_EQ(stored.view().rows_of(stored.view().primitives.size() - 1).rows, 3 * terms);
            EXPECT_EQ(stored.version_of(kPrimSection), 1u) << "earlier readers read it";
        }
    }
}

// Readers that expect three bands in media must not take such a file for a damaged one.
TEST(OpalFile, MediaOfOneBandComeBackUnderAVersionOfTheirOwn) {
    for (const bool is_separate : {false, true}) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, is_separate ? 5 : 4, 1.3f, is_separate, 1);
        tests::add_translucent_triangle(asset, 4, 1.4f, false, 3);
        const StoredAsset stored(asset);
        EXPECT_EQ(stored.version_of(kPrimSection), 2u);
        expect_same_bytes(stored.view().primitives, asset.primitives);
        tests::expect_same_rows(stored.view().transport, asset.transport.view());
    }
}

// The fault of an asset with a medium, with gloss if asked for, after a change.
enum class Surfaces { plain, glossy_media, all_glossy };
template <class Change>
std::string fault_with(Surfaces surfaces, Change change) {
    Asset asset = tests::make_small_asset();
    tests::add_translucent_triangle(asset, 4, 1.3f);
    if (surfaces == Surfaces::glossy_media) tests::add_gloss(asset);
    if (surfaces == Surfaces::all_glossy) tests::add_opaque_gloss(asset);
    return tests::fault_after(asset, change);
}

TEST(OpalFile, ImpossibleShadingIsRefusedByName) {
    const auto fault_of = [](auto change) {
        return fault_with(Surfaces::plain, [&](Asset& asset) { change(asset.primitives); });
    };
    using Primitives = std::vector<PrimitiveRecord>;
    EXPECT_EQ(fault_of([](Primitives&) {}), "");
    for (const std::uint32_t terms : {0u, 2u, 3u, 5u, 36u, 0xffffffffu}) {
        EXPECT_THAT(fault_of([terms](Primitives& p) { p[2].terms = terms; }), HasSubstr("terms"));
    }
    for (const std::uint32_t bands : {0u, 2u, 4u, 0xffffffffu}) {
        EXPECT_THAT(fault_of([bands](Primitives& p) { p[2].bands = bands; }),
                    testing::AllOf(HasSubstr(std::to_string(bands) + " bands"),
                                   HasSubstr("expected"), HasSubstr("1 or 3 bands")));
    }
    for (const float eta : {0.0f, 0.33f, 3.01f, -1.3f, kUndefined, kUnbounded}) {
        EXPECT_THAT(fault_of([eta](Primitives& p) { p[2].eta = eta; }),
                    HasSubstr("index of refraction"));
        if (eta != 0) {
            EXPECT_THAT(fault_of([eta](Primitives& p) { p[0].eta = eta; }),
                        HasSubstr("index of refraction"));
        }
    }
    EXPECT_THAT(fault_of([](Primitives& p) { p[0].terms = 4; }), HasSubstr("terms"));
    EXPECT_THAT(fault_of([](Primitives& p) { p[1].shading = static_cast<Shading>(4); }),
                HasSubstr("shading 4"));
    // More rows than there are, by the number of terms.
    EXPECT_NE(fault_of([](Primitives& p) { p[2].terms = 9; }), "");
}

TEST(OpalFile, ThinWalledSurfacesHaveARowForEachSideAndASectionVersionOfTheirOwn) {
    Asset asset = tests::make_small_asset();
    tests::add_sheet_triangle(asset);
    tests::expect_refused(
        asset, "PRIM",
        {{[](Asset& a) { a.primitives[2].terms = 1; }, "thin-walled shading with 1 terms"},
         {[](Asset& a) { a.primitives[2].eta = 1.3f; }, "index of refraction 1.3"},
         {[](Asset& a) { a.primitives[2].bands = 2; }, "2 bands"},
         {[](Asset& a) { a.primitives[2].flags = PrimitiveRecord::kSeparate; },
          "separate scattering"}});
    asset = tests::make_small_asset();
    tests::add_sheet_triangle(asset, 1);
    const StoredAsset stored(asset);
    EXPECT_EQ(stored.view().primitives[2].shading, Shading::sheet);
    EXPECT_EQ(stored.version_of(kPrimSection), 4u);
}

TEST(OpalFile, SeparateScatteringHasOneRowMoreThanItsHarmonics) {
    const auto fault_of = [](std::uint32_t terms, bool is_separate) {
        Asset asset = tests::make_small_asset();
        tests::add_translucent_triangle(asset, terms, 1.3f, is_separate);
        return tests::fault_of(asset, Checks::full);
    };
    for (const std::uint32_t single : {0u, 1u, 4u, 9u, 16u, 25u}) {
        EXPECT_EQ(fault_of(1 + single, true), "") << single;
    }
    for (const std::uint32_t terms : {3u, 4u, 6u, 9u, 25u, 27u}) {
        EXPECT_THAT(fault_of(terms, true), HasSubstr("terms"));
    }
    EXPECT_NE(fault_of(26, false), "");
    EXPECT_NE(
        tests::fault_after(tests::make_small_asset(),
                           [](Asset& a) { a.primitives[0].flags |= PrimitiveRecord::kSeparate; }),
        "");
}

TEST(OpalFile, SingleScatteringAloneRaisesTheVersionOfPrimitives) {
    Asset asset = tests::make_small_asset();
    tests::add_translucent_triangle(asset, 4, 1.3f);
    asset.primitives[2].flags |= PrimitiveRecord::kSingleOnly;
    const StoredAsset stored(asset);
    EXPECT_TRUE(stored.view().primitives[2].is_single_only());
    EXPECT_EQ(stored.version_of(kPrimSection), 3u);
    asset.primitives[0].flags |= PrimitiveRecord::kSingleOnly;  // opaque
    EXPECT_NE(tests::fault_of(asset, Checks::structure), "");
    asset.primitives[0].flags = 0;
    asset.primitives[2].flags |= PrimitiveRecord::kSeparate;
    EXPECT_NE(tests::fault_of(asset, Checks::structure), "");
}

TEST(OpalFile, SpecularComesBackAndIsAbsentWithoutIt) {
    Asset asset = tests::make_small_asset();
    tests::add_translucent_triangle(asset, 4, 1.3f);
    const StoredAsset plain(asset);
    EXPECT_TRUE(plain.view().roughness.empty() && plain.view().openness.empty());
    EXPECT_EQ(plain.loaded->sections.size(), 6u);
    tests::add_gloss(asset);
    const StoredAsset stored(asset);
    expect_same_bytes(stored.view().roughness, asset.roughness);
    expect_same_bytes(stored.view().openness, asset.openness);
    EXPECT_EQ(stored.version_of(kSpecSection), 1u);
    EXPECT_EQ(stored.version_of(kGlosSection), 0u);
    tests::add_opaque_gloss(asset);
    const StoredAsset glossy(asset);
    expect_same_bytes(glossy.view().gloss, asset.gloss);
    EXPECT_EQ(glossy.version_of(kGlosSection), 1u);
}

TEST(OpalFile, ImpossibleSpecularIsRefusedByName) {
    const auto fault_of = [](auto change) { return fault_with(Surfaces::glossy_media, change); };
    EXPECT_EQ(fault_of([](Asset&) {}), "");
    for (const float roughness : {-0.5f, 1.01f, kUndefined, kUnbounded}) {
        EXPECT_THAT(fault_of([roughness](Asset& a) { a.roughness[2] = roughness; }),
                    StartsWith("section SPEC, primitive 2"));
    }
    EXPECT_THAT(fault_of([](Asset& a) { a.roughness[0] = 0.2f; }),
                StartsWith("section SPEC, primitive 0"));
    EXPECT_THAT(fault_of([](Asset& a) { a.roughness.pop_back(); }), StartsWith("section SPEC:"));
    EXPECT_THAT(fault_of([](Asset& a) { a.openness.pop_back(); }), StartsWith("section SPEC:"));
}

TEST(OpalFile, ImpossibleGlossIsRefusedByName) {
    const auto expect_refused = [](const char* where, auto change) {
        EXPECT_THAT(fault_with(Surfaces::all_glossy, change),
                    StartsWith(std::string("section GLOS") + where + ": "));
    };
    EXPECT_EQ(fault_with(Surfaces::all_glossy, [](Asset&) {}), "");
    for (const float bad : {-0.5f, 1.01f, kUndefined, kUnbounded}) {
        expect_refused(", primitive 1", [bad](Asset& a) { a.gloss[1].roughness = bad; });
        expect_refused(", primitive 1", [bad](Asset& a) { a.gloss[1].metallic = bad; });
        expect_refused(", primitive 0", [bad](Asset& a) { a.gloss[0].f0.g = bad; });
        expect_refused(", primitive 0", [bad](Asset& a) { a.gloss[0].f90 = bad; });
    }
    expect_refused(", primitive 2", [](Asset& a) { a.gloss[2].roughness = 0.2f; });  // translucent
    expect_refused(", primitive 0", [](Asset& a) { a.gloss[0].image = 1; });
    expect_refused(", primitive 0", [](Asset& a) { a.gloss[0].wrap_u = static_cast<Wrap>(3); });
    expect_refused("", [](Asset& a) { a.gloss.pop_back(); });
    expect_refused("", [](Asset& a) { a.roughness.clear(), a.openness.clear(); });
}

}  // namespace
}  // namespace opaline::formats
