#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/reference/estimate.h"
#include "bake/reference/path.h"
#include "bake/reference/reference_receivers.h"
#include "tests/support/scenes.h"

namespace opaline::tests {

/// Radiance 1 from above, 0 from below, or the other way round. Rows are fine, so that the
/// interpolated edge at the horizon carries nothing.
inline formats::Environment make_half_sky(bool above) {
    formats::Environment sky;
    sky.width = 2;
    sky.height = 4096;
    for (std::uint32_t row = 0; row < sky.height; ++row) {
        const float value = (row < sky.height / 2) == above ? 1.0f : 0.0f;
        sky.pixel.insert(sky.pixel.end(), 2, {value, value, value});
    }
    return sky;
}

inline formats::Environment make_white_sky() {
    formats::Environment sky;
    sky.width = 2;
    sky.height = 1;
    sky.pixel.assign(2, {1, 1, 1});
    return sky;
}

inline formats::Medium make_medium(float sigma_t, float albedo, float g, float eta) {
    const float s = albedo * sigma_t, a = sigma_t - s;
    formats::Medium medium;
    medium.sigma_s = {s, s, s};
    medium.sigma_a = {a, a, a};
    medium.eta = eta;
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    medium.phase.g = g;
    return medium;
}

/// A scene and its light, ready to be walked.
struct ReferenceFixture {
    Scene input;
    formats::Environment sky;
    bake::ReferenceScene scene;
    bake::LightSampler light;

    bake::PathSpace space(bake::PathOptions options = {}) const { return {scene, light, options}; }
};

inline std::unique_ptr<ReferenceFixture> make_fixture(Scene input, formats::Environment sky) {
    auto heart =
        std::make_unique<std::pair<Scene, formats::Environment>>(std::move(input), std::move(sky));
    auto fixture = std::unique_ptr<ReferenceFixture>(
        new ReferenceFixture{std::move(heart->first),
                             std::move(heart->second),
                             bake::make_reference_scene(Scene{}, 1).value(),
                             {}});
    auto scene = bake::make_reference_scene(fixture->input, 0);
    EXPECT_TRUE(scene);
    fixture->scene = std::move(scene).value();
    fixture->light = bake::make_light_sampler(fixture->sky, glm::mat3(1.0f));
    return fixture;
}

/// A slab of a medium between y = -thickness / 2 and thickness / 2, practically without an end.
inline Scene make_slab(const formats::Medium& medium, float thickness) {
    Primitive slab = make_cube(1, false);
    for (glm::vec3& p : slab.position) {
        p *= glm::vec3(400, 0.5f, 400) * thickness;
    }
    Scene scene = make_scene({slab});
    scene.materials[0].medium = medium;
    return scene;
}

inline bake::Moments merged(const std::vector<bake::Moments>& parts) {
    bake::Moments all;
    for (const bake::Moments& m : parts) {
        all.merge(m);
    }
    return all;
}

/// `samples` of what `trace` finds with a stream of random numbers, in 16 independent parts.
template <class Trace>
std::vector<bake::Moments> trace_in_parts(std::uint32_t samples, Trace&& trace) {
    bake::EstimateOptions options;
    options.samples = std::max(samples / 16, 1u);
    auto estimate = bake::estimate_pixels(
        16, options, {}, [&](std::uint32_t, bake::RandomStream& random) { return trace(random); });
    EXPECT_TRUE(estimate);
    EXPECT_LT(static_cast<double>(estimate->lost), 1e-5 * samples + 0.5);
    return std::move(estimate->pixel);
}

/// Radiance along one ray.
inline bake::Moments look(const bake::PathSpace& space, glm::vec3 from, glm::vec3 direction,
                          std::uint32_t samples, const bake::SurroundingMedia& around = {}) {
    return merged(trace_in_parts(samples, [&](bake::RandomStream& random) {
        return bake::trace_ray(space, from, direction, random, around);
    }));
}

/// Radiance that leaves a slab upward, in 16 independent parts: toward a direction of cosine
/// `cosine` to the normal, or where that is 0 averaged over directions with the cosine as weight.
/// Not near the slab's middle, where its triangles meet.
inline std::vector<bake::Moments> look_down_in_parts(const bake::PathSpace& space, float top,
                                                     float cosine, std::uint32_t samples) {
    return trace_in_parts(samples, [&](bake::RandomStream& random) {
        const float c = cosine > 0 ? cosine : std::sqrt(1 - random.next());
        const float s = std::sqrt(1 - c * c);
        const glm::vec3 direction(s * 0.8f, -c, s * 0.6f);
        const float x = 20 * random.next() + 3, z = 20 * random.next() - 40;
        return bake::trace_ray(space, 2 * top * glm::vec3(x, 1, z), direction, random);
    });
}
inline bake::Moments look_down(const bake::PathSpace& space, float top, float cosine,
                               std::uint32_t samples) {
    return merged(look_down_in_parts(space, top, cosine, samples));
}

/// Radiance of receivers, so many samples of each.
inline bake::Moments mean_over(const bake::PathSpace& space,
                               const std::vector<bake::ReferenceReceiver>& receivers,
                               std::uint32_t samples) {
    bake::EstimateOptions options;
    options.samples = samples;
    const auto estimate = bake::estimate_receivers(space, receivers, options, {});
    EXPECT_TRUE(estimate);
    return merged(estimate->pixel);
}

/// A sun that gives white surfaces which face it a radiance of 1.
inline formats::Light unit_sun(glm::vec3 travel) {
    const float pi = std::numbers::pi_v<float>;
    formats::Light sun;
    sun.type = formats::Light::Type::directional;
    sun.direction = glm::normalize(travel);
    sun.intensity = {pi, pi, pi};
    return sun;
}

inline double standard_error(const bake::Moments& m) {
    return std::sqrt(m.variance_of_mean().x);
}

/// Fresnel transmittance and refracted cosine, written once more for the tests.
inline double transmittance(double c, double eta) {
    const double squared = 1 - (1 - c * c) / (eta * eta);
    if (squared <= 0) return 0;
    const double t = std::sqrt(squared);
    const double s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    return 1 - 0.5 * (s * s + p * p);
}

}  // namespace opaline::tests
