// Pictures with fidelity "paper": formulas of [Premoze2003] as printed, against closed forms.
#include <cmath>
#include <numbers>

#include "bake/lab/path_images/image_lights.h"
#include "bake/physics/gauss_legendre.h"
#include "bake/physics/path_integral/quasi_path.h"
#include "bake/physics/phase.h"
#include "tests/bake/path_images/path_image_support.h"
#include "tests/bake/path_integral/path_support.h"

namespace opaline::tests {
namespace {

using formats::TermSet;

using std::numbers::pi;

formats::Volume printed(formats::Volume volume) {
    volume.paper = true;
    return volume;
}

formats::Volume make_ball_of(float sigma_t, float albedo, float g) {
    return make_volume(make_ball_grid(1, 1.0 / 16), sigma_t, albedo, g);
}

// Along z through a place in the ball's middle plane.
double look_through(const formats::Volume& volume, const formats::Environment& light, float aside,
                    const bake::PathImageOptions& options) {
    return look_along(*make_volume_scene(volume, light), {aside, 0, -3}, {0, 0, 1}, options).x;
}

// [Premoze2003] (12) of a Henyey-Greenstein function: its power s over the integral, in closed
// form.
double power_of(double g, double ell, double cosine) {
    const double s = -std::expm1(-ell) / ell, e = 1 - 1.5 * s;
    const double integral = 2 * pi * std::pow(1 - g, 3 * s) *
                            (std::pow(1 + g, 2 * e) - std::pow(1 - g, 2 * e)) / (2 * g * e);
    const double p = bake::henyey_greenstein(cosine, g) / bake::henyey_greenstein(1, g);
    return std::pow(p, s) / integral;
}

// A sun straight ahead: the path is the ray. Of two zonal functions, the convolution at cosine 1 is
// the integral of their product.
TEST(PaperFidelity, LightOfASunAheadIsThePowerLawAlongTheRay) {
    constexpr double kG = 0.6, kDepth = 3;
    const bake::GaussLegendre rule = bake::make_gauss_legendre(48);
    double light = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double ell = kDepth * rule.node[i];
        double twice = 0;
        for (std::size_t j = 0; j < rule.node.size(); ++j) {
            const double cosine = 2 * rule.node[j] - 1;
            twice += 4 * pi * rule.weight[j] * power_of(kG, ell, cosine) *
                     bake::henyey_greenstein(cosine, kG);
        }
        light += kDepth * rule.weight[i] * -std::expm1(-ell) * twice * std::exp(ell - kDepth);
    }
    EXPECT_NEAR(look_through(printed(make_ball_of(kDepth / 2, 1, kG)),
                             make_distant_light({0, 0, 1}), 0, plain(TermSet::volume_multiple)) /
                    light,
                1, 0.02);
}

// Isotropic scattering has no law of directions: only the choice of one path is left. With
// alpha = 1/4 and a turn of a right angle the attenuation is 0.62 / ell + A.
TEST(PaperFidelity, OfThreePathsTheOneOfLeastAttenuationIsTaken) {
    const auto light = make_distant_light({1, 0, 0});
    struct Case {
        float albedo;
        double length;  // 2: nothing is absorbed. 1/2: much is
    };
    for (const Case& c : {Case{1, 2}, Case{0.25f, 0.5}}) {
        const formats::Volume ball = make_ball_of(1 / c.albedo, c.albedo, 0);
        bake::PathImageOptions options = plain(TermSet::volume_multiple);
        const double paper = look_through(printed(ball), light, 0.1f, options);
        for (const double length : {0.5, 1.0, 2.0}) {
            options.lengths = {length};
            const double one = look_through(ball, light, 0.1f, options);
            if (length == c.length) {
                EXPECT_NEAR(paper / one, 1, 1e-5) << c.albedo;
            } else {
                EXPECT_GT(std::abs(paper / one - 1), 0.01) << c.albedo << ' ' << length;
            }
        }
    }
}

// (20, 21) by hand for a ball that absorbs nothing, so that the longest paths are taken: e^-tau of
// the sky behind, and from each cell of the sky w_b times the power law.
double ball_in_white_sky(double sigma_t, double g, double aside) {
    const Ball ball{sigma_t, 1, 1};
    const glm::dvec3 v(0, 0, 1), start(aside, 0, -std::sqrt(1 - aside * aside) + 1e-9);
    const double straight = sigma_t * 2 * std::sqrt(1 - aside * aside);
    const bake::MarchLimits limits{.box = cube(1.2), .step = 0.01};
    std::vector<double> ell;
    for (const glm::dvec3& cell : bake::sky_cells()) {
        const bake::Turns turns(v, cell);
        ell.push_back(bake::march_quasi_path({start, turns[0], 2 * straight}, ball, limits,
                                             [](const bake::PathStep&) { return true; })
                          .ell);
    }
    double sum = 0;
    for (const bake::SkyTexel& texel : bake::make_even_sky().texel) {
        const double cosine = glm::dot(v, texel.direction);
        const double depth = cosine > std::cos(bake::kAheadAngle) ? straight : ell[texel.cell];
        const double law = g == 0 ? 1 / (4 * pi) : power_of(g, depth, cosine);
        sum += texel.solid_angle * -std::expm1(-depth) * law;
    }
    return std::exp(-straight) + sum;
}

TEST(PaperFidelity, SkyEntersWherePathsLeaveTheVolume) {
    for (const float g : {0.0f, 0.7f}) {
        const formats::Volume ball = make_ball_of(1, 1, g);
        const double by_hand = ball_in_white_sky(1, static_cast<double>(g), 0.5);
        const auto look = [&](TermSet terms) {
            return look_through(printed(ball), make_white_sky(), 0.5f, plain(terms));
        };
        EXPECT_NEAR(look(TermSet::all) / by_hand, 1, 0.01) << g;
        EXPECT_EQ(look(TermSet::volume_single), 0) << "all of it is of the boundary";
        // The straight ray loses less or more than curved paths bring: no even light.
        EXPECT_GT(std::abs(by_hand - 1), 0.015) << g;
    }
}

TEST(PaperFidelity, SurfacesHideTheSkyFromPathsThatLeave) {
    const auto look = [](float y) {
        return look_along(*make_volume_scene(printed(make_ball_of(1, 1, 0)), make_white_sky(),
                                             make_square(y, 9)),
                          {0, 0, -3}, {0, 0, 1}, plain(TermSet::volume_multiple))
            .x;
    };
    // The lower half but for its horizon.
    EXPECT_NEAR(look(-1.5f) / look(-2000), 0.51, 0.02);
}

TEST(PaperFidelity, HasNoRenormalisation) {
    bake::PathImageOptions options;
    options.terms = TermSet::volume_multiple;
    const formats::Volume ball = printed(make_ball_of(2, 1, 0.5f));
    options.renormalise = true;
    const double asked = look_through(ball, make_distant_light({1, 0, 0}), 0, options);
    options.renormalise = false;
    EXPECT_EQ(asked, look_through(ball, make_distant_light({1, 0, 0}), 0, options));
}

TEST(PaperFidelity, VolumesOfBothFidelitiesInOneSceneAreRefused) {
    Scene scene;
    scene.volumes = {make_ball_of(1, 1, 0), printed(make_ball_of(1, 1, 0))};
    EXPECT_FALSE(bake::check_path_scene(scene));
    scene.volumes[0].paper = true;
    EXPECT_TRUE(bake::check_path_scene(scene));
    EXPECT_TRUE(bake::has_paper_fidelity(scene));
}

}  // namespace
}  // namespace opaline::tests
