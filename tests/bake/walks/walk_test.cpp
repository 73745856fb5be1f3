#include "bake/effects/multiple/walks/walk.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bake/effects/multiple/walks/view_fit.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/half_space_once.h"
#include "tests/bake/walks/body_walks.h"
#include "tests/support/doubled_slab.h"

namespace opaline::tests {
namespace {

// What a half space of isotropic scatterers, index 1, shows of uniform light at the cosines of a
// Gauss-Legendre rule: 1 - sqrt(1 - a) H(mu).
std::vector<double> half_space_by_view(double albedo, const bake::GaussLegendre& rule) {
    std::vector<double> radiance = chandrasekhar_h(albedo, rule);
    for (double& value : radiance) {
        value = 1 - std::sqrt(1 - albedo) * value;
    }
    return radiance;
}

// Its weighted least-squares fit linear in the cosine.
struct LinearFit {
    double mean = 0, slope = 0;  // the reflectance; the slope about the mean cosine, 2/3
};
LinearFit fit_half_space(double albedo) {
    const bake::GaussLegendre rule = bake::make_gauss_legendre(64);
    const std::vector<double> radiance = half_space_by_view(albedo, rule);
    constexpr double kMean = 2.0 / 3, kVariance = 1.0 / 18;
    LinearFit fit;
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        const double p = 2 * rule.weight[i] * rule.node[i];
        fit.mean += p * radiance[i];
        fit.slope += p * radiance[i] * (rule.node[i] - kMean) / kVariance;
    }
    return fit;
}

// Whatever the body, its parts and its holes: no weight is dropped without a count.
TEST(Walk, LightLeavesMeetsASurfaceIsAbsorbedOrIsLostAndInNoOtherWay) {
    const auto expect_all = [](const WalkedBody& body, const bake::WalkStart& start,
                               const char* what) {
        constexpr std::uint32_t kWalks = 20000;
        const auto counts = visit_walks(body.space, start, {2}, kWalks, [](const auto&) {});
        const auto all = static_cast<double>(counts.walks);
        for (std::size_t b = 0; b < 3; ++b) {
            if (body.space.is_grey && b > 0) continue;
            const double scattered = counts.ends.all(b), straight = counts.straight.all(b);
            EXPECT_NEAR((scattered + straight) / all, 1, 0.02) << what;
            EXPECT_NEAR(scattered / counts.scattered[b], 1, 0.02) << what;
            EXPECT_NEAR((counts.scattered[b] + straight) / all, 1, 0.02) << what;
        }
        return counts;
    };
    const bake::WalkStart top = start_below({0, 0, 0}, {0, 1, 0});
    const bake::WalkStart pole = start_below({0, 0.995f, 0}, {0, 1, 0});
    const auto slab =
        expect_all(*make_walked_body(make_wide_slab(2), make_forward_medium(1, 0.7f, 0.3f, 1.4f)),
                   top, "slab");
    EXPECT_GT(slab.straight.left[0], 0.02 * 20000) << "crosses it unscattered";
    EXPECT_GT(slab.ends.absorbed[0], 0.2 * 20000);
    const auto coloured = expect_all(
        *make_walked_body(make_sphere(3), make_coloured_medium({4, 8, 20}, {2, 0, 1}), false), pole,
        "coloured ball");
    EXPECT_EQ(coloured.ends.absorbed[1], 0) << "a band of albedo 1";
    EXPECT_EQ(coloured.ends.met[0], 0);
    const auto hole = expect_all(
        *make_walked_body(make_open_ball(), make_forward_medium(2, 0.9f, 0, 1.3f)), pole, "hole");
    EXPECT_GT(hole.ends.unfinished[0], 100);
    EXPECT_GT(hole.straight.unfinished[0], 0);
    Primitive core = make_sphere(3, 0.6f);
    core.material = 1;
    Scene around =
        make_translucent_scene({make_sphere(3), core}, make_forward_medium(3, 1, 0, 1.3f));
    around.materials[1].base_color = {0.5f, 0.5f, 0.5f};
    const auto opaque = expect_all(*make_walked_scene(std::move(around)), pole, "opaque core");
    EXPECT_GT(opaque.ends.absorbed[0], 0.03 * 20000) << "by the core, after scattering";
    EXPECT_GT(opaque.straight.met[0], 0.05 * 20000) << "met before any scattering";
}

// Of albedo 1 all that scatters leaves: what crosses, e^-2, is made up for.
TEST(Walk, WalksThatScatterStandForThoseThatCross) {
    const auto slab = make_walked_body(make_wide_slab(2), make_forward_medium(1, 1, 0, 1));
    bake::WalkStart start = start_below({0, 0, 0}, {0, 1, 0});
    start.seen = start.normal;
    const auto leaving = [&](const bake::WalkOrders& orders) {
        double sum = 0;
        const auto counts = visit_walks(slab->space, start, orders, 20000, [&](const auto& exits) {
            for (const bake::WalkExit& exit : exits) {
                sum += static_cast<double>(exit.weight[0]) / 20000;
            }
        });
        return sum * counts.crossed_correction({1, 0, 0});
    };
    EXPECT_NEAR(leaving({1, false, false}), 1 - std::exp(-2), 0.01);
    EXPECT_NEAR(leaving({1, false, true}), 1, 1e-4);
}

// Total reflectance of a half space, with the boundary's own.
TEST(Walk, RefractingHalfSpaceAlongItsNormalReflectsWhatGiovanelliTabulated) {
    const auto slab = make_walked_body(make_wide_slab(60), make_forward_medium(1, 0.9f, 0, 1.5f));
    bake::WalkStart start = start_below({0, 0, 0}, {0, 1, 0});
    start.seen = start.normal;
    const Leaving leaving = walk_from(slab->space, start, 1, 200000);
    constexpr double kBoundary = 0.04;
    EXPECT_NEAR(kBoundary + (1 - kBoundary) * leaving.all, 0.2600, 4 * leaving.error + 5e-4);
    EXPECT_LT(leaving.error, 0.001);
}

// Light along the normal of a slab by where it leaves toward, as MCML's third test has it after van
// de Hulst's table 35; here against doubling, which is itself held to the table's totals. By
// reciprocity walks along the normal are that light. Total transmission includes what passes
// unscattered; walks do not.
TEST(Walk, SlabAlongItsNormalSendsLightTowardEveryAngleAsDoublingSays) {
    constexpr int kBins = 10;
    const DoubledSlab doubled(2, 0.9, 0.75, kBins);
    std::array<double, 2 * kBins> expected{};  // reflected, then transmitted
    for (int i = 0; i < doubled.nodes(); ++i) {
        const auto bin = static_cast<std::size_t>(i / DoubledSlab::kPerBin);
        const double flux = 2 * std::numbers::pi * doubled.cosine(i) * doubled.weight(i);
        expected[bin] += flux * doubled.reflected_beam(i);
        expected[kBins + bin] += flux * doubled.transmitted_beam(i);
    }
    const auto half = expected.begin() + kBins;
    EXPECT_NEAR(std::accumulate(expected.begin(), half, 0.0), 0.09739, 1e-5);
    EXPECT_NEAR(std::accumulate(half, expected.end(), 0.0), 0.66096 - std::exp(-2), 1e-5);

    constexpr std::uint32_t kWalks = 200000;
    const auto slab = make_walked_body(make_wide_slab(2), make_forward_medium(1, 0.9f, 0.75f, 1));
    bake::WalkStart start = start_below({0, 0, 0}, {0, 1, 0});
    start.seen = start.normal;
    std::array<double, 2 * kBins> mean{}, squares{};
    visit_walks(slab->space, start, {1}, kWalks, [&](const auto& exits) {
        for (const bake::WalkExit& exit : exits) {  // one: nothing is reflected
            const float cosine = std::abs(exit.direction.y);
            const auto bin =
                std::min(static_cast<std::size_t>(kBins * cosine), std::size_t{kBins - 1}) +
                (exit.direction.y > 0 ? 0 : kBins);
            const auto weight = static_cast<double>(exit.weight[0]);
            mean[bin] += weight / kWalks;
            squares[bin] += weight * weight / kWalks;
        }
    });
    double chi_square = 0;
    for (std::size_t i = 0; i < mean.size(); ++i) {
        const double error = std::sqrt((squares[i] - mean[i] * mean[i]) / kWalks);
        EXPECT_NEAR(mean[i], expected[i], 4 * error) << "bin " << i;
        EXPECT_LT(error, 0.06 * expected[i]) << "bin " << i;
        chi_square += std::pow((mean[i] - expected[i]) / error, 2);
    }
    const double reflected = std::accumulate(mean.begin(), mean.begin() + kBins, 0.0);
    EXPECT_NEAR(reflected, 0.09739, 4 * std::sqrt(reflected / kWalks));
    EXPECT_LT(chi_square, 2 * kBins + 4 * std::sqrt(4.0 * kBins));
}

// Rows by view of walks from the top of a half space or slab: means with their standard errors.
struct WalkedViews {
    double mean = 0, mean_error = 0;
    std::array<double, bake::kAllDegrees> row{}, error{};
};

WalkedViews walk_views(const bake::WalkSpace& space, std::uint32_t walks) {
    const bake::ViewFit fit = bake::make_view_fit(static_cast<double>(space.eta));
    const glm::vec3 up(0, 1, 0);
    WalkedViews views;
    std::vector<bake::WalkExit> exits;
    bake::WalkCounts counts;
    for (std::uint32_t w = 0; w < walks; ++w) {
        bake::WalkRandom random({1, bake::RandomStage::body_walk, 7, w});
        exits.clear();
        const glm::vec3 seen =
            bake::follow_walk(space, {}, start_below({0, 0, 0}, up), {1}, random, exits, counts);
        EXPECT_GT(seen.y, 0) << "toward the eye";
        double sum = 0;
        for (const bake::WalkExit& exit : exits) {
            sum += static_cast<double>(exit.weight[0]);
        }
        views.mean += sum / walks;
        views.mean_error += sum * sum / walks;
        const bake::ViewLobe lobe = bake::eval_view_lobe(fit, up, seen, true);
        for (std::size_t r = 0; r < lobe.size(); ++r) {
            const double part = sum * static_cast<double>(lobe[r]);
            views.row[r] += part / walks;
            views.error[r] += part * part / walks;
        }
    }
    views.mean_error = std::sqrt((views.mean_error - views.mean * views.mean) / walks);
    for (std::size_t r = 0; r < views.row.size(); ++r) {
        views.error[r] = std::sqrt((views.error[r] - views.row[r] * views.row[r]) / walks);
    }
    return views;
}

// The rows by view are the best linear function of the cosine.
TEST(Walk, HalfSpaceReturnsAndDarkensTowardTheEdgeAsTheLinearFitOfChandrasekharsFunctionSays) {
    for (const float albedo : {0.5f, 0.9f, 0.99f, 1.0f}) {
        const auto slab =
            make_walked_body(make_wide_slab(60), make_forward_medium(1, albedo, 0, 1));
        const WalkedViews views = walk_views(slab->space, 100000);
        const auto fit = fit_half_space(static_cast<double>(albedo));
        EXPECT_NEAR(views.row[1], fit.slope, 4 * views.error[1]) << albedo;
        EXPECT_LT(views.error[1], 0.02);
        if (albedo < 1) {
            EXPECT_NEAR(views.mean, fit.mean, 4 * views.mean_error) << albedo;
            EXPECT_LT(views.mean_error, 0.003);
        }
        for (const std::size_t across : {0u, 2u, 3u, 4u, 6u}) {  // x, z, xy, yz and xz
            EXPECT_NEAR(views.row[across], 0, 4 * views.error[across])
                << "a plane looks the same from all sides";
        }
    }
}

// Light enters a share 1 - F_ext of what arrives; half_space_once counts what arrives.
TEST(Walk, LightScatteredOnceIsThatOfAHalfSpaceByQuadrature) {
    for (const float eta : {1.0f, 1.3f, 1.5f, 0.8f}) {
        const auto slab =
            make_walked_body(make_wide_slab(60), make_forward_medium(1, 0.8f, 0, eta));
        const bake::WalkStart start = start_below({0, 0, 0}, {0, 1, 0});
        // The same walks: what the second leaves out is scattered once.
        const Leaving all = walk_from(slab->space, start, 1, 200000);
        const Leaving more = walk_from(slab->space, start, 2, 200000);
        const auto index = static_cast<double>(eta);
        const double once =
            bake::half_space_once(index) * 0.8 / (1 - bake::fresnel_moments(index).external);
        EXPECT_NEAR(all.all - more.all, once, 0.01 * once + 0.0015) << eta;
    }
}

TEST(Walk, LightScatteredOnceIsMarkedWhereItCountsForDiffuseLightAlone) {
    const auto slab =
        make_walked_body(make_wide_slab(60), make_forward_medium(1, 0.8f, 0.3f, 1.3f));
    const bake::WalkStart start = start_below({0, 0, 0}, {0, 1, 0});
    const auto sum_up = [&](bake::WalkOrders orders, bool is_once) {
        double sum = 0;
        visit_walks(slab->space, start, orders, 2000, [&](const auto& exits) {
            for (const bake::WalkExit& exit : exits) {
                sum += exit.is_once == is_once ? static_cast<double>(exit.weight[0]) : 0;
            }
        });
        return sum;
    };
    const double once = sum_up({2, true}, true), more = sum_up({2, false}, false);
    EXPECT_GT(once, 0.1 * more);
    EXPECT_EQ(sum_up({2, true}, false), more);
    EXPECT_EQ(sum_up({2, false}, true), 0);
    EXPECT_NEAR(once + more, sum_up({1, false}, false), 1e-6 * more);
}

// What enters a conservative slab leaves on one of both sides. Of uniform light, the share 4/3 /
// (tau' + 2 * 0.7104) crosses, 0.7104 being the extrapolation length of Milne's problem (asymptotic
// in tau').
TEST(Walk, ConservativeSlabTransmitsByItsTransportThicknessWhateverTheMeanCosine) {
    for (const float g : {-0.5f, 0.0f, 0.5f, 0.9f}) {
        const float thickness = 8;  // transport mean free paths of 1 m
        const auto slab =
            make_walked_body(make_wide_slab(thickness), make_forward_medium(1 / (1 - g), 1, g, 1));
        const Leaving leaving = walk_from(slab->space, start_below({0, 0, 0}, {0, 1, 0}), 1, 20000);
        EXPECT_NEAR(leaving.all, 1, 4 * leaving.error + 0.001) << g;
        EXPECT_NEAR(leaving.below, 4.0 / 3 / (static_cast<double>(thickness) + 1.4208), 0.008) << g;
    }
}

}  // namespace
}  // namespace opaline::tests
