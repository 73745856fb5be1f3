#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "runtime/terms.h"
#include "runtime/view_terms.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/shade_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;

constexpr std::array<float, 8> kEtas{formats::kMinEta, 0.7f, 0.99999f, 1.0f,
                                     1.00001f,         1.3f, 1.5f,     formats::kMaxEta};

// The textbook Fresnel formula (formats/README.md), in double precision.
double textbook_transmittance(double c, double eta) {
    const double s2 = (1 - c * c) / (eta * eta);
    if (s2 >= 1) return 0;
    const double ct = std::sqrt(1 - s2);
    const double rs = (c - eta * ct) / (c + eta * ct), rp = (eta * c - ct) / (eta * c + ct);
    return 1 - (rs * rs + rp * rp) / 2;
}

Vec3 random_direction(std::mt19937& generator) {
    std::normal_distribution<float> normal;
    return normalize(Vec3{normal(generator), normal(generator), normal(generator)});
}

formats::PrimitiveRecord translucent(float eta) {
    formats::PrimitiveRecord primitive;
    primitive.shading = formats::Shading::translucent;
    primitive.eta = eta;
    return primitive;
}

TEST(FresnelTransmittance, IsTheFormulaAtEveryAngleWithoutItsCancellation) {
    for (const float eta : kEtas) {
        for (int i = 1; i <= 2000; ++i) {
            const float c = static_cast<float>(i) / 2000.0f;
            const double expected = textbook_transmittance(c, eta);
            // Toward the critical angle Ft goes as the root of this; so does its rounding.
            const double under_root = (eta - 1.0) * (eta + 1.0) + static_cast<double>(c) * c;
            const double slack = 2e-7 / std::sqrt(std::max(under_root, 1e-7));
            EXPECT_NEAR(fresnel_transmittance(c, eta), expected, 2e-6 + slack)
                << "c " << c << ", eta " << eta;
        }
    }
}

TEST(FresnelTransmittance, OfAnIndexMatchedBoundaryIsOneDownToGrazing) {
    for (const float c : {1.0f, 0.1f, 1e-3f, 1e-8f, 1e-15f}) {
        EXPECT_NEAR(fresnel_transmittance(c, 1), 1, 1e-6) << c;
    }
}

TEST(FresnelTransmittance, IsZeroBehindAtTotalReflectionAndForNonsense) {
    for (const float c : {0.0f, -0.0f, -0.5f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_EQ(fresnel_transmittance(c, 1.3f), 0) << c;
        EXPECT_EQ(fresnel_transmittance(c, 1.0f), 0) << c;
    }
    EXPECT_EQ(fresnel_transmittance(0.5f, 0.7f), 0);  // sin = 0.87 > 0.7
    EXPECT_GT(fresnel_transmittance(0.8f, 0.7f), 0);  // sin = 0.6
    EXPECT_EQ(fresnel_transmittance(2, 1.3f), fresnel_transmittance(1, 1.3f));
}

TEST(Refraction, ObeysSnellInThePlaneOfIncidence) {
    std::mt19937 generator(1);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 n = random_direction(generator);
        Vec3 w = random_direction(generator);
        float c = dot(n, w);
        if (c < 0) {
            w = -1.0f * w;
            c = -c;
        }
        for (const float eta : kEtas) {
            const double sine = length(cross(n, w));
            if (sine / eta > 0.999) continue;
            const Vec3 inside = refract_to_eye(n, w, c, eta);
            EXPECT_NEAR(length(inside), 1, 3e-6);
            EXPECT_NEAR(length(cross(n, inside)), sine / eta, 3e-6);
            EXPECT_GT(dot(n, inside), 0);
            EXPECT_NEAR(dot(inside, cross(n, w)), 0, 3e-6);
            // And back through the boundary.
            const Vec3 back = refract_to_eye(n, inside, dot(n, inside), 1 / eta);
            // Toward grazing a rounding of c' moves c by eta^2 c' / c times as much.
            EXPECT_NEAR(length(back - w), 0, 2e-6 + 1e-6 * std::max(1.0f, eta * eta) / c)
                << eta;  // a root of roundings near grazing
        }
    }
}

TEST(Refraction, ContinuesAcrossTheSilhouetteAndTotalReflection) {
    const Vec3 n{0, 0, 1};
    for (const float eta : kEtas) {
        const auto refract = [&](float c) {
            return refract_to_eye(n, {std::sqrt(1 - c * c), 0, c}, c, eta);
        };
        EXPECT_NEAR(length(refract(1e-7f) - refract(-1e-7f)), 0, 1e-3) << eta;
        for (const float c : {-1.0f, -0.9f, -0.1f, 0.0f, 0.1f}) {
            EXPECT_NEAR(length(refract(c)), 1, 3e-6) << eta << ", " << c;
            EXPECT_GE(dot(n, refract(c)), -1e-6f);
        }
    }
}

TEST(ViewOfReceiver, IsTowardTheEyeOrAlongTheNormal) {
    formats::PrimitiveRecord single, both;
    both.flags = formats::PrimitiveRecord::kDoubleSided;
    const Vec3 n{0, 1, 0};
    const ViewOfReceiver none = view_receiver(single, {1, 2, 3}, n, {});
    EXPECT_EQ(none.to_eye, n);
    EXPECT_EQ(none.cosine, 1);
    EXPECT_EQ(view_receiver(single, {1, 2, 3}, n, Vec3{1, 2, 3}).to_eye, n);
    const ViewOfReceiver front = view_receiver(single, {1, 2, 3}, n, Vec3{4, 6, 3});
    EXPECT_NEAR(front.cosine, 0.8f, 1e-6f);
    EXPECT_NEAR(length(front.to_eye - Vec3{0.6f, 0.8f, 0}), 0, 1e-6f);
    const ViewOfReceiver behind = view_receiver(single, {1, 2, 3}, n, Vec3{4, -2, 3});
    EXPECT_NEAR(behind.cosine, -0.8f, 1e-6f);
    EXPECT_EQ(behind.normal, n);
    const ViewOfReceiver flipped = view_receiver(both, {1, 2, 3}, n, Vec3{4, -2, 3});
    EXPECT_NEAR(flipped.cosine, 0.8f, 1e-6f);
    EXPECT_EQ(flipped.normal, (Vec3{0, -1, 0}));
    // Squares of these leave the range of floats.
    const ViewOfReceiver far = view_receiver(single, {0, -1e30f, 0}, n, Vec3{1e30f, 0, 0});
    EXPECT_NEAR(far.cosine, std::numbers::sqrt2 / 2, 1e-6);
    // Without a normal there is nothing to refract through: black, but finite.
    const ViewOfReceiver bare = view_receiver(single, {}, {}, {});
    EXPECT_EQ(fresnel_transmittance(bare.cosine, 1.3f), 0);
    const std::array<Rgb, 4> product{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}};
    EXPECT_TRUE(std::isfinite(sum_view_terms(bare, translucent(1.3f), product).r));
}

// Henyey-Greenstein is diagonal in spherical harmonics with eigenvalues g^l (Funk-Hecke):
// rows g^l Y_lm(-w_i') give back the phase function, up to the degrees left out.
TEST(ViewTerms, SumToTheTruncatedPhaseFunctionOfTheRefractedDirection) {
    constexpr double g = 0.25, eta = 1.3;
    std::mt19937 generator(2);
    for (int i = 0; i < 200; ++i) {
        const Vec3 n = random_direction(generator), w_in = random_direction(generator);
        Vec3 w_out = random_direction(generator);
        if (dot(n, w_out) < 0) w_out = -1.0f * w_out;
        const ViewOfReceiver view{n, w_out, dot(n, w_out)};
        const Vec3 inside = refract_to_eye(n, w_out, view.cosine, static_cast<float>(eta));
        std::array<float, 25> y{};
        formats::eval_spherical_harmonics(-1.0f * w_in, y);
        std::array<Rgb, 25> product{};
        for (std::size_t k = 0; k < product.size(); ++k) {
            const double row = std::pow(g, std::floor(std::sqrt(static_cast<double>(k)))) * y[k];
            product[k] = {static_cast<float>(row), 0, static_cast<float>(2 * row)};
        }
        // Propagation directions: in -w_in, out along `inside`.
        const double cosine = -dot(w_in, inside);
        const double expected =
            (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
        const Rgb sum = sum_view_terms(view, translucent(static_cast<float>(eta)), product);
        // What is left out is at most sum_{l > 4} (2 l + 1) g^l / (4 pi) = 0.0012.
        EXPECT_NEAR(sum.r, expected, 1.3e-3);
        EXPECT_FLOAT_EQ(sum.b, 2 * sum.r);
        EXPECT_EQ(sum.g, 0);
    }
}

using formats::Asset;
using formats::PrimitiveRecord;
using formats::TermSet;

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
