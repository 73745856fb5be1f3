#include "runtime/volumes/relight_volumes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "runtime/volumes/node_radiance.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/volumes/lit_volumes.h"

namespace opaline::runtime {
namespace {

using formats::NodeVoxel;
using formats::Rgb;
using formats::SparseRow;
using formats::TermSet;
using formats::Vec3;
using test::kSize;
using test::LitTestVolumes;
using test::TestVolume;

TEST(RelightVolumes, IsotropicSingleScatteringIsTheLightOverTheSphere) {
    TestVolume volume;
    volume.single_terms = 1;
    const LightVector light = test::texel_light(kSize, 17, {1, 2, 4});
    const LitTestVolumes lit({volume}, light);
    ASSERT_EQ(lit.light.part.size(), 1u);
    EXPECT_EQ(lit.light.part[0].terms, 1u);
    ASSERT_EQ(lit.light.coefficient.size(), 8u);
    for (const Rgb j : node_radiance(lit.view, lit.light, 0, std::nullopt)) {
        EXPECT_NEAR(j.r, tests::flux(light, 0) / (4 * std::numbers::pi), 1e-7);
        EXPECT_NEAR(j.g, 2 * j.r, 1e-7);
        EXPECT_NEAR(j.b, 4 * j.r, 1e-7);
    }
}

// sum_l (2 l + 1) / (4 pi) m_l P_l(cosine).
double phase(const std::array<float, 5>& moment, double c) {
    const double p[] = {1, c, 1.5 * c * c - 0.5, 2.5 * c * c * c - 1.5 * c,
                        (35 * c * c * c * c - 30 * c * c + 3) / 8};
    double sum = 0;
    for (std::size_t l = 0; l < 5; ++l) {
        sum += (2.0 * static_cast<double>(l) + 1) / (4 * std::numbers::pi) * moment[l] * p[l];
    }
    return sum;
}

TEST(RelightVolumes, SingleScatteringFollowsThePhaseFunction) {
    TestVolume volume;
    volume.single_terms = 25;
    volume.moment = {1, 0.45f, 0.3f, 0.2f, 0.12f};
    constexpr std::uint32_t texel = 3 * kSize * kSize + 2 * kSize + 5;
    const LightVector light = test::texel_light(kSize, texel, {1, 1, 1});
    const Vec3 toward_light = formats::texel_direction(kSize, 3, 2, 5);
    const LitTestVolumes lit({volume}, light);
    const double flux = tests::flux(light, 0);
    bool has_forward = false;
    for (const Vec3 eye : {Vec3{90, 20, -50}, Vec3{-3, 70, 2}, Vec3{1, -80, 30}, Vec3{-60, 1, 9}}) {
        const auto radiance = node_radiance(lit.view, lit.light, 0, eye);
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            const NodeVoxel node = lit.view.node[i];
            const Vec3 to_eye = formats::normalize(eye - Vec3{static_cast<float>(node[0]),
                                                              static_cast<float>(node[1]),
                                                              static_cast<float>(node[2])});
            // Light from `toward_light` goes on toward the eye: the cosine of its turn.
            const double expected = phase(volume.moment, -dot(to_eye, toward_light)) * flux;
            EXPECT_NEAR(radiance[i].r, std::max(0.0, expected), 2e-6 * flux);
            has_forward = has_forward || expected > 0.2 * flux;
        }
    }
    EXPECT_TRUE(has_forward);
}

TEST(RelightVolumes, MultipleScatteringOfOneTermHasFactorOne) {
    TestVolume volume;
    volume.single_terms = 4;
    volume.multiple_terms = 1;
    volume.moment = {1, 0.5f, 0, 0, 0};
    volume.rows = [](NodeVoxel) {
        return std::vector<SparseRow>{test::constant_row(kSize, 0.25f),
                                      test::constant_row(kSize, 0.125f)};
    };
    const auto first = [&](TermSet terms) {
        const LitTestVolumes lit({volume}, test::white_light(kSize), {.terms = terms});
        return node_radiance(lit.view, lit.light, 0, Vec3{100, 3, 4}).front().r;
    };
    const double four_pi = 4 * std::numbers::pi;
    EXPECT_NEAR(first(TermSet::volume_multiple), 0.125 * four_pi, 1e-4);
    EXPECT_NEAR(first(TermSet::volume_single), 0.25, 1e-5);
    EXPECT_NEAR(first(TermSet::all), 0.25 + 0.125 * four_pi, 1e-4);
    EXPECT_EQ(first(TermSet::diffuse), 0);
}

TEST(RelightVolumes, TermsOfMoreHarmonicsAddUpAndHaveNoMeanBeyondTheFirst) {
    TestVolume volume;
    volume.multiple_terms = 4;
    volume.bands = 3;
    volume.rows = [](NodeVoxel) {
        return std::vector<SparseRow>{
            test::constant_row(kSize, 0, 3), test::constant_row(kSize, 1, 3),
            test::constant_row(kSize, 0, 3), test::constant_row(kSize, 0, 3),
            test::constant_row(kSize, 0.1f, 3)};
    };
    const LitTestVolumes lit({volume});
    EXPECT_EQ(lit.light.part[0].terms, 4u);
    const double four_pi = 4 * std::numbers::pi, y0 = 1 / std::sqrt(four_pi);
    EXPECT_NEAR(node_radiance(lit.view, lit.light, 0, std::nullopt)[0].g, four_pi * y0, 1e-4);
    // Y_3 = sqrt(3 / (4 pi)) x.
    EXPECT_NEAR(node_radiance(lit.view, lit.light, 0, Vec3{1e6f, 0, 0})[0].g,
                four_pi * (y0 + 0.1 * std::sqrt(3.0) * y0), 1e-4);
}

TEST(RelightVolumes, IsTheSameForAnyNumberOfThreadsAndSecondVolumesHaveTheirOwnRows) {
    formats::Volumes volumes = test::make_volumes(kSize);
    for (const float factor : {1.0f, 3.0f}) {
        TestVolume volume;
        volume.spacing = 1;
        volume.extent = {2, 1, 1};
        volume.single_terms = 9;
        volume.multiple_terms = 4;
        volume.moment = {1, 0.6f, 0.3f, 0, 0};
        volume.rows = [&](NodeVoxel node) {
            std::vector<SparseRow> rows;
            for (int i = 0; i < 5; ++i) {
                rows.push_back(test::constant_row(kSize, factor * static_cast<float>(i + node[0])));
                rows.back().index = {3, 70};
                rows.back().value = {factor, factor * static_cast<float>(node[1])};
            }
            return rows;
        };
        test::add_volume(volumes, volume);
    }
    const auto view = volumes.view();
    const LightVector light =
        project_environment(tests::lat_long_map(64, 32, tests::smooth_sky), kSize);
    const VolumeLight one = relight_volumes(view, light, {.threads = 1});
    const VolumeLight many = relight_volumes(view, light, {.threads = 7});
    EXPECT_EQ(one.coefficient, many.coefficient);
    for (std::uint32_t node = 0; node < view.records[0].node_count; node += 50) {
        for (std::size_t k = 0; k < 9; ++k) {
            const float a = one.coefficients(0, node)[k].g, b = one.coefficients(1, node)[k].g;
            EXPECT_NEAR(b, 3 * a, 1e-3 * std::abs(b) + 1e-2);
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
