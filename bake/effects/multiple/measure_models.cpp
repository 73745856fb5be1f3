#include "bake/effects/multiple/measure_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/multiple/rule_layers.h"
#include "bake/effects/multiple/thin_parts.h"
#include "bake/effects/multiple/true_multiple.h"
#include "bake/effects/multiple/walks/true_walks.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {

std::vector<TestLight> make_pilot_lights() {
    constexpr std::array<glm::vec3, 3> kSuns{
        {{0.36f, 0.48f, 0.8f}, {-0.8f, 0.6f, 0}, {0.48f, -0.36f, -0.8f}}};
    constexpr float kSunRadius = 0.0046f;  // [rad]
    const std::size_t texels = formats::cubemap_texels(kTruthCubemap);
    const std::vector<double> solid_angle = formats::texel_solid_angles(kTruthCubemap);
    std::vector<TestLight> lights(1 + kSuns.size());
    for (TestLight& light : lights) {
        light.smooth.assign(texels, 0.0f);
    }
    for (std::size_t j = 0; j < texels; ++j) {
        lights[0].smooth[j] = static_cast<float>(solid_angle[j % solid_angle.size()]);
    }
    for (std::size_t s = 0; s < kSuns.size(); ++s) {
        lights[s + 1].discs.push_back({kSuns[s], kSunRadius, std::numbers::pi});
    }
    return lights;
}

namespace {

// Sums over receivers and lights; a product of two independent estimates has no noise on average.
struct Squares {
    double dipole = 0, truth = 0;
};

Squares compare(const TwoEstimates& walked, const TwoEstimates& dipole) {
    Squares squares;
    for (std::size_t l = 0; l < walked.first.size(); ++l) {
        const double a = walked.first[l], b = walked.second[l];
        squares.dipole += (dipole.first[l] - a) * (dipole.second[l] - b);
        squares.truth += a * b;
    }
    return squares;
}

}  // namespace

ModelErrors measure_models(const EffectInputs& inputs, const MediumProfile& profile,
                           std::uint64_t& traced) {
    constexpr std::size_t kReceivers = 64;
    constexpr std::uint32_t kFromEach = 512, kPoints = 256, kRaysPerSun = 1;
    const std::vector<BodyPoint> points = draw_body_points(inputs, kReceivers);
    const std::vector<TestLight> lights = make_pilot_lights();
    const SunRays suns = make_sun_rays(lights, kRaysPerSun);
    const SmoothLights smooth = make_smooth_lights(lights);
    const WalkSpace space =
        make_walk_space(inputs.bake.scene, inputs.bake.rays.hierarchy(), inputs.material,
                        inputs.layout.bands() == 1, inner_materials(inputs));
    const WalkLight walk_light{inputs.outside(), suns,     smooth, make_exit_lobe(profile.eta),
                               profile.exit,     kFromEach};
    const SurfaceIntegral integral =
        make_surface_integral(inputs.bake.scene, inputs.material, profile);
    struct Part {
        Squares squares;
        std::uint64_t rays = 0;
    };
    Squares sum;
    for_each_block_in_order(
        points.size(), 1, inputs.context,
        [&](Range range) {
            Part part;
            const BodyPoint& point = points[range.begin];
            const auto key = static_cast<std::uint32_t>(range.begin);
            part.squares = compare(
                walk_to_lights(space, walk_light, point, {}, inputs.knobs.seed, key, part.rays),
                integrate_multiple(integral,
                                   {inputs.bake.scene, inputs.outside(), suns, smooth, kPoints},
                                   point.position, {inputs.knobs.seed, key}, part.rays));
            return part;
        },
        [&](Range, Part&& part) {
            sum.dipole += part.squares.dipole;
            sum.truth += part.squares.truth;
            traced += part.rays;
        });
    if (!(sum.truth > 0)) {
        return {};
    }
    return {std::sqrt(std::max(0.0, sum.dipole / sum.truth)),
            static_cast<std::uint32_t>(points.size())};
}

}  // namespace opaline::bake
