#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "bake/reference/hit_scene.h"
#include "bake/reference/random_stream.h"
#include "bake/scene/punctual_light.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The emissive triangles and the lights of a scene, to choose from.
struct LampSampler {
    struct Triangle {
        std::uint32_t primitive = 0, triangle = 0;  ///< numbers of formats::Scene
        glm::vec3 normal{0};                        ///< unit, by its winding
        float density = 0;                          ///< of sample_triangle over its area [1/m^2]
        bool is_two_sided = false;
    };
    std::vector<Triangle> triangles;
    /// Shares of the power up to each triangle, the last one 1.
    std::vector<double> cumulative;
    /// By primitive and triangle: Triangle::density; empty for primitives that do not glow.
    std::vector<std::vector<float>> density;
    std::vector<formats::Light> lights;  ///< those with an intensity above 0

    bool empty() const { return triangles.empty() && lights.empty(); }
};

LampSampler make_lamp_sampler(const formats::Scene& scene);

/// Whether light leaves the side of a surface from which a ray of `direction` sees it.
bool is_seen_to_glow(const formats::Material& material, glm::vec3 direction, glm::vec3 flat);

/// Radiance [nit] of a glowing surface. `view`: as base_color_at's.
glm::vec3 emission_of(const formats::Scene& scene, const SurfaceHit& hit,
                      const TextureView* view = nullptr);
glm::vec3 emission_of_vertex(const formats::Scene& scene, std::uint32_t primitive,
                             std::uint32_t vertex);

/// A point of a glowing surface, seen from a point.
struct SeenTriangle {
    std::uint32_t primitive = 0, triangle = 0;
    glm::vec3 direction{0};  ///< unit, to it
    glm::vec3 radiance{0};   ///< [nit] toward the point
    float pdf = 0;           ///< over solid angle [1/sr]
};

/// A point on the emissive triangles: a triangle in proportion to its power, a point uniform over
/// it. Nothing where its dark side faces `from`. Precondition: there are triangles.
std::optional<SeenTriangle> sample_triangle(const LampSampler& lamps, const formats::Scene& scene,
                                            glm::vec3 from, RandomStream& random);

/// Density [1/sr] with which sample_triangle has the direction to this hit, seen from `from`.
float pdf_triangle(const LampSampler& lamps, const SurfaceHit& hit, glm::vec3 from);

/// One of the lights, in proportion to its irradiance at a point if nothing is between, that
/// irradiance divided by the probability. Nothing where no light arrives.
std::optional<ArrivingLight> sample_punctual(const LampSampler& lamps, glm::vec3 at,
                                             RandomStream& random);

}  // namespace opaline::bake
