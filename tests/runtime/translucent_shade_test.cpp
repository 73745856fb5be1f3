#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "runtime/view_terms.h"
#include "tests/runtime/shade_test_support.h"
#include "tests/support/float_traps.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::PrimitiveRecord;
using formats::Rgb;
using formats::Vec3;
using tests::shaded;

/// A grey diffuse primitive, then a translucent one of random rows with `terms` rows a vertex and
/// normals in all directions.
Asset make_translucent_asset(std::uint32_t terms, float eta = 1.3f, std::uint32_t flags = 0) {
    Asset asset;
    tests::add_random_primitive(asset, 8, {}, 31);
    PrimitiveRecord record;
    record.shading = formats::Shading::translucent;
    record.terms = terms;
    record.bands = 3;
    record.eta = eta;
    record.flags = flags;
    tests::add_random_primitive(asset, 8, record, 40, 2);  // over a block for many terms
    return asset;
}

Rgb product(const Asset& asset, const LightVector& light, std::uint32_t vertex,
            std::uint32_t term) {
    const PrimitiveRecord& p = asset.primitives[1];
    std::vector<Rgb> out(1);
    dot_rows(asset.transport.view(), asset.view().rows_of(1), light,
             (vertex - p.first_vertex) * p.terms + term, out, best_dot_path());
    return out[0];
}

TEST(TranslucentShade, AddsAllTermsAtTheRefractedDirectionToTheEye) {
    const Vec3 eye{3, 2, -4};
    for (const std::uint32_t terms : {1u, 4u, 9u, 16u, 25u}) {
        const Asset asset = make_translucent_asset(terms);
        const LightVector light = tests::random_light(8, 5);
        const std::vector<Rgb> out = shaded(asset, light, {.eye = eye});
        std::size_t lit = 0;
        for (std::uint32_t v = asset.primitives[1].first_vertex; v < out.size(); ++v) {
            const Vec3 w = normalize(eye - asset.position[v]), n = asset.normal[v];
            const double c = dot(n, w), eta = 1.3;
            double expected = 0;
            if (c > 0) {
                const double inside = std::sqrt(1 - (1 - c * c) / (eta * eta));
                const Vec3 refracted =
                    static_cast<float>(1 / eta) * (w - static_cast<float>(c) * n) +
                    static_cast<float>(inside) * n;
                std::vector<float> h(terms);
                formats::eval_spherical_harmonics(refracted, h);
                for (std::uint32_t k = 0; k < terms; ++k) {
                    expected += static_cast<double>(product(asset, light, v, k).g) *
                                (terms == 1 ? 1.0 : static_cast<double>(h[k]));
                }
                const double rs = (c - eta * inside) / (c + eta * inside);
                const double rp = (eta * c - inside) / (eta * c + inside);
                expected *= 0.25 * (1 - (rs * rs + rp * rp) / 2);
            }
            EXPECT_NEAR(out[v].g, std::max(0.0, expected), 1e-5 * (1 + std::abs(expected)))
                << "terms " << terms << ", vertex " << v;
            lit += out[v].g > 0 ? 1u : 0u;
        }
        EXPECT_GT(lit, 10u);
    }
}

TEST(TranslucentShade, BackFacesAreBlackUnlessDoubleSided) {
    const Vec3 eye{0, 20, 0};
    const Asset single = make_translucent_asset(4),
                both = make_translucent_asset(4, 1.3f, PrimitiveRecord::kDoubleSided);
    const LightVector light = tests::random_light(8, 8);
    const auto a = shaded(single, light, {.eye = eye}), b = shaded(both, light, {.eye = eye});
    std::size_t behind = 0, seen = 0;
    for (std::uint32_t v = single.primitives[1].first_vertex; v < a.size(); ++v) {
        if (dot(single.normal[v], eye - single.position[v]) > 0) {
            EXPECT_EQ(a[v], b[v]);
        } else {
            ++behind;
            EXPECT_EQ(a[v], Rgb{});
            seen += b[v] == Rgb{} ? 0u : 1u;
        }
    }
    EXPECT_GT(behind, 10u);
    EXPECT_GT(seen, behind / 2);  // random rows: the rest is negative in all bands
}

TEST(TranslucentShade, ThreadsRangesAndPathsAgree) {
    const Asset asset = make_translucent_asset(25);
    const LightVector light = tests::random_light(8, 9);
    ShadeOptions options{.eye = Vec3{0, 3, 3}};
    tests::expect_same_in_threads_and_ranges(asset, light, options);
    const auto one = shaded(asset, light, options);
    options.path = DotPath::scalar;
    const auto many = shaded(asset, light, options);
    for (std::size_t v = 0; v < one.size(); ++v) {
        EXPECT_NEAR(many[v].r, one[v].r, 1e-4f) << v;  // sums of 25 dot products of order 1
    }
}

TEST(TranslucentShade, WithoutFresnelKeepsTheSignThatAPixelClampsLater) {
    const Asset asset = make_translucent_asset(1);
    const LightVector light = tests::random_light(8, 10);
    const auto out =
        shaded(asset, light, {.base_color = false, .eye = Vec3{0, 3, 3}, .fresnel = false});
    std::size_t negative = 0;
    for (std::uint32_t v = asset.primitives[1].first_vertex; v < out.size(); ++v) {
        EXPECT_EQ(out[v], product(asset, light, v, 0));
        negative += out[v].r < 0 ? 1u : 0u;
    }
    EXPECT_GT(negative, 10u);
}

TEST(TranslucentShade, NothingButFiniteNumbersComesOut) {
    const opaline::tests::UntrappedFloats untrapped;  // what is given overflows
    Asset asset = make_translucent_asset(9);
    const float largest = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < asset.transport.detail_scale.size(); i += 2) {
        asset.transport.detail_scale[i] = largest;
    }
    asset.normal[60] = {};
    asset.normal[61] = {std::nanf(""), 0, 0};
    asset.position[62] = {largest, -largest, largest};
    for (const bool fresnel : {true, false}) {
        const auto out = shaded(asset, tests::random_light(8, 11),
                                {.eye = Vec3{-largest, 0, 0}, .fresnel = fresnel});
        tests::expect_finite(out);
        if (fresnel) {
            EXPECT_EQ(out[60], Rgb{});
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
