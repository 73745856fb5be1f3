#include "runtime/terms.h"

#include <gmock/gmock.h>

#include "runtime/view_terms.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/shade_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::PrimitiveRecord;
using formats::Rgb;
using formats::TermSet;
using formats::Vec3;

/// A grey diffuse and a glossy translucent primitive with `terms` rows a vertex, radiance above 0.
Asset make_layered_asset(std::uint32_t terms, bool is_separate) {
    Asset asset;
    tests::add_random_primitive(asset, 8, {}, 31);
    PrimitiveRecord record;
    record.shading = formats::Shading::translucent;
    record.terms = terms;
    record.bands = 3;
    record.eta = 1.4f;
    record.flags = is_separate ? PrimitiveRecord::kSeparate : 0;
    tests::add_random_primitive(asset, 8, record, 40);
    asset.roughness = {formats::kNotGlossy, 0.25f};
    for (const Vec3 normal : asset.normal) {
        asset.openness.push_back(formats::encode_openness(normal, 0.7f));
    }
    return asset;
}

class Terms : public testing::Test {
  protected:
    std::vector<Rgb> shaded(const Asset& asset, TermSet terms, bool fresnel = true) {
        return tests::shaded(
            asset, light_,
            {.eye = Vec3{0, 2, 5}, .fresnel = fresnel, .terms = terms, .specular = &specular_});
    }
    formats::Environment sky_ = tests::lat_long_map(64, 32, tests::smooth_sky);
    LightVector light_ = project_environment(sky_, 8);
    std::uint32_t level_ = roughness_level(0.25f);
    SpecularLight specular_ = prefilter_specular(sky_, {&level_, 1}, {}, 1);
};

// Before the last factor, where negative sums of random rows are not yet clamped.
TEST_F(Terms, MultipleAndSingleAddUpToBoth) {
    for (const std::uint32_t terms : {1u, 2u, 5u, 10u, 17u, 26u}) {
        const Asset asset = make_layered_asset(terms, true);
        const auto both = shaded(asset, TermSet::multiple | TermSet::single, false);
        const auto multiple = shaded(asset, TermSet::multiple, false);
        const auto single = shaded(asset, TermSet::single, false);
        std::size_t differ = 0;
        for (std::uint32_t v = asset.primitives[1].first_vertex; v < both.size(); ++v) {
            const float sum = multiple[v].g + single[v].g;
            EXPECT_NEAR(both[v].g, sum, 1e-5f * (std::abs(multiple[v].g) + std::abs(single[v].g)));
            differ += single[v].g != 0 && multiple[v].g != 0 ? 1u : 0u;
        }
        EXPECT_EQ(differ > 10, terms > 1) << terms;
    }
}

TEST_F(Terms, ComponentsAddUpToTheWholeWhereNoneIsClamped) {
    const Asset asset = make_layered_asset(5, true);
    const auto whole = shaded(asset, TermSet::all);
    std::vector<std::vector<Rgb>> parts;
    for (const TermSet term :
         {TermSet::multiple, TermSet::single, TermSet::specular, TermSet::diffuse}) {
        parts.push_back(shaded(asset, term));
    }
    const auto multiple = shaded(asset, TermSet::multiple, false);
    const auto single = shaded(asset, TermSet::single, false);
    std::size_t compared = 0;
    for (std::size_t v = 0; v < whole.size(); ++v) {
        if (multiple[v].r < 0 || single[v].r < 0) continue;
        const float sum = parts[0][v].r + parts[1][v].r + parts[2][v].r + parts[3][v].r;
        EXPECT_NEAR(whole[v].r, sum, 1e-5f * (1 + sum)) << v;
        compared += sum > 0 ? 1u : 0u;
        EXPECT_TRUE(v < asset.primitives[1].first_vertex ? parts[0][v] == Rgb{}
                                                         : parts[3][v] == Rgb{});
    }
    EXPECT_GT(compared, 20u);
}

// The second row of a separate asset is what a merged one has; its harmonics begin anew.
TEST_F(Terms, SingleScatteringHasTheViewTermsOfItsOwnNumberOfRows) {
    const Asset asset = make_layered_asset(5, true);
    const auto single = shaded(asset, TermSet::single, false);
    const PrimitiveRecord& p = asset.primitives[1];
    for (std::uint32_t v = p.first_vertex; v < single.size(); ++v) {
        std::vector<Rgb> rows(5);
        dot_rows(asset.transport.view(), p.rows(p.vertex_count), light_, (v - p.first_vertex) * 5,
                 rows, best_dot_path());
        const ViewOfReceiver view =
            view_receiver(p, asset.position[v], asset.normal[v], Vec3{0, 2, 5});
        std::vector<float> h(4);
        eval_view_terms(refract_to_eye(view.normal, view.to_eye, view.cosine, 1.4f), h);
        float expected = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            expected += h[k] * rows[k + 1].b;
        }
        EXPECT_NEAR(single[v].b, expected, 1e-5f * (1 + std::abs(expected)));
    }
}

// Review 1, fault 12: after a bake of single scattering alone it could not be shown by itself.
TEST_F(Terms, RowsOfSingleScatteringAloneShowIt) {
    for (const std::uint32_t terms : {1u, 4u}) {
        Asset asset = make_layered_asset(terms, false);
        const auto whole = shaded(asset, TermSet::all, false);
        asset.primitives[1].flags |= PrimitiveRecord::kSingleOnly;
        EXPECT_TRUE(check_terms(asset.view(), TermSet::single));
        EXPECT_TRUE(check_terms(asset.view(), TermSet::multiple));
        EXPECT_EQ(shaded(asset, TermSet::all, false), whole);
        const auto single = shaded(asset, TermSet::single, false);
        const auto multiple = shaded(asset, TermSet::multiple, false);
        for (std::uint32_t v = asset.primitives[1].first_vertex; v < whole.size(); ++v) {
            EXPECT_EQ(single[v], whole[v]);
            EXPECT_EQ(multiple[v], Rgb{});
        }
    }
}

TEST_F(Terms, MergedRowsAreShownWholeOrNotAtAll) {
    const Asset merged = make_layered_asset(4, false), apart = make_layered_asset(5, true);
    for (std::uint32_t bits = 0; bits <= static_cast<std::uint32_t>(TermSet::baked); ++bits) {
        const auto terms = static_cast<TermSet>(bits);
        const bool needs_both =
            has_any(terms, TermSet::multiple) != has_any(terms, TermSet::single);
        const auto status = check_terms(merged.view(), terms, "a.opal");
        EXPECT_EQ(status.has_value(), !needs_both) << bits;
        EXPECT_TRUE(check_terms(apart.view(), terms, "a.opal"));
        if (!status) {
            const formats::Diagnostic& main = status.error().diagnostics.front();
            EXPECT_EQ(main.file, "a.opal");
            EXPECT_EQ(main.where, "primitive 1");
            EXPECT_THAT(main.remedy, testing::HasSubstr("--separate-terms"));
        }
    }
    for (const Rgb c : shaded(merged, TermSet::none)) {
        EXPECT_EQ(c, Rgb{});
    }
}

}  // namespace
}  // namespace opaline::runtime
