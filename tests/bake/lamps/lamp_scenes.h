#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/exchange/lamps/lamps.h"
#include "bake/exchange/lamps/receiver_light.h"
#include "bake/exchange/lamps/trace_particles.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/ray_scene.h"
#include "tests/support/scenes.h"

namespace opaline::tests {

/// Adds a quad of its own node and material. Radiance [nit] in all bands.
inline formats::Material& add_surface(Scene& scene, Primitive primitive, float albedo,
                                      float radiance = 0) {
    primitive.node = static_cast<std::uint32_t>(scene.primitives.size());
    primitive.material = static_cast<std::uint32_t>(scene.materials.size());
    scene.primitives.push_back(std::move(primitive));
    formats::Material material;
    material.base_color = {albedo, albedo, albedo};
    material.emission = {radiance, radiance, radiance};
    scene.materials.push_back(std::move(material));
    return scene.materials.back();
}

/// Square z = 0 of radiance 1 / pi (exitance 1) that shines up, and one at z = 1 that faces it.
inline Scene parallel_squares(std::uint32_t cells = 1) {
    Scene scene;
    add_surface(scene, make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0,
                std::numbers::inv_pi_v<float>);
    add_surface(scene, make_quad({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, cells), 0);
    return scene;
}

inline bake::RayScene build_rays(const Scene& scene) {
    return std::move(*bake::RayScene::build(scene, 1));
}

/// The receivers of all primitives.
inline std::vector<bake::ReceiverSet> receivers_of(const Scene& scene) {
    const std::vector<bake::Receiver> outside = bake::make_vertex_receivers(scene);
    std::vector<bake::BodyPoint> inside(outside.size());
    for (std::size_t i = 0, p = 0; p < scene.primitives.size(); ++p) {
        for (const glm::vec3& position : scene.primitives[p].position) {
            // Mirrors the origin, as make_body_points does.
            inside[i] = {position, outside[i].normal, 2.0f * position - outside[i].origin,
                         scene.primitives[p].material};
            ++i;
        }
    }
    return bake::make_vertex_sets(scene, outside, inside);
}

inline std::vector<bake::LampSources> all_sources(const Scene& scene) {
    std::vector<bake::LampSources> sources;
    for (const bake::Lamp& lamp : bake::list_lamps(scene)) {
        sources.push_back(bake::make_lamp_sources(scene, lamp));
    }
    return sources;
}

/// Form factor of a point beside the corner of a parallel rectangle x by y at distance 1.
inline double corner_factor(double x, double y) {
    const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * std::numbers::pi);
}
/// Irradiance at (s, t) from the parallel unit square of exitance 1 at distance 1.
inline double square_irradiance(double s, double t) {
    return corner_factor(1 - s, 1 - t) + corner_factor(s, 1 - t) + corner_factor(1 - s, t) +
           corner_factor(s, t);
}

/// The lamps of a scene, and what their particles bring by metals and media alone.
struct LampWorld {
    LampWorld(Scene given, double finest, bake::ParticleRun run)
        : scene(std::move(given)), layout(scene, finest) {
        run.ends_diffuse = true;
        std::uint64_t traced = 0;
        for (run.lamp = 0; run.lamp < sources.size(); ++run.lamp) {
            particles.push_back(
                bake::trace_particles(scene, rays, sources[run.lamp], layout, run, {}, traced));
            const auto& caustic = particles.back().caustic;
            caustics.push_back(caustic.empty() ? bake::ElementLight{}
                                               : layout.join(caustic, bake::kCausticElements));
        }
    }
    bake::LampLight light(std::uint32_t samples = 256) const {
        return {scene, rays, sources, samples, 0, caustics, &layout};
    }
    /// Without what surfaces reflect diffusely.
    glm::dvec3 at(const bake::Receiver& receiver) const {
        std::uint64_t traced = 0;
        return bake::receive_straight(light(64), receiver, traced)[0];
    }

    Scene scene;
    bake::ElementLayout layout;
    bake::RayScene rays = build_rays(scene);
    std::vector<bake::LampSources> sources = all_sources(scene);
    std::vector<bake::ReceiverSet> receivers = receivers_of(scene);
    std::vector<bake::ElementLight> caustics;
    std::vector<bake::ParticleLight> particles;
};

/// 512 x 512 squares of black and white, over a metre.
inline std::uint32_t add_checker(Scene& scene) {
    constexpr std::uint32_t kSide = 512;
    formats::Image8& image = scene.images.emplace_back(formats::Image8{kSide, kSide, {}});
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
        const std::uint8_t value = (i % kSide + i / kSide) % 2 == 0 ? 255 : 0;
        image.rgba.insert(image.rgba.end(), {value, value, value, 255});
    }
    for (Primitive& p : scene.primitives) {
        p.texcoord.clear();
        for (const glm::vec3& at : p.position) {
            p.texcoord.emplace_back(at.x, at.y);
        }
    }
    return 0;
}

/// A floor under a ceiling that glows and reflects nothing.
inline Scene floor_under_ceiling(float albedo) {
    Scene scene;
    add_surface(scene, make_quad({0, 0, 1}, {0, 1, 0}, {1, 0, 0}, 4), 0, 1);
    add_surface(scene, make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), albedo);
    return scene;
}

}  // namespace opaline::tests
