#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/lights/luminance.h"
#include "bake/lights/test_lights.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/direction_set.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

struct DensitySpace;

/// The share of the sky's light from a direction that volumes let through to a place, of white
/// light by its luminance; null: all.
double let_through(const DensitySpace* between, glm::vec3 from, glm::vec3 direction);

/// Rays to all suns of the test lights; each represents an equal part of its disc.
struct SunRays {
    struct Packet {
        RayPacket::Lane dir_x, dir_y, dir_z;  ///< unit
        RayPacket::Lane flux;                 ///< luminance times solid angle; 0: an unused lane
        std::array<std::uint32_t, RayPacket::kSize> light;
    };
    std::vector<Packet> packets;
    const DensitySpace* between = nullptr;  ///< volumes that dim them; null: none
};

/// `per_sun`: rays to each disc, >= 1.
SunRays make_sun_rays(std::span<const TestLight> lights, std::uint32_t per_sun,
                      const DensitySpace* between = nullptr);

/// Of the lanes that are on (-1), those between whose origin and the sky nothing stands stay so.
/// Returns the number of rays.
std::uint64_t keep_unoccluded(const RayScene& rays, RayPacket& packet, LaneMask& lanes);

/// A factor of the light from direction w: constant + linear . w + w . square w.
struct LightFactor {
    double constant = 1;
    glm::dvec3 linear{0};
    glm::dmat3 square{0};

    double at(glm::dvec3 w) const {
        return constant + glm::dot(linear, w) + glm::dot(w, square * w);
    }
};

/// Adds the irradiance by suns, times Ft(eta, n.w) and the factor, to that of each light. eta = 1:
/// a diffuse surface. Returns the number of rays.
std::uint64_t add_sun_irradiance(const RayScene& rays, const SunRays& suns,
                                 const Receiver& receiver, double eta, std::span<double> irradiance,
                                 const LightFactor& factor = {});

/// The smooth part of all lights side by side: radiance[texel * lights + l], mean over the texels
/// of kTruthCubemap.
struct SmoothLights {
    std::size_t lights = 0;
    std::vector<float> radiance;
    const DensitySpace* between = nullptr;  ///< volumes that dim them; null: none

    const float* towards(glm::vec3 direction) const;
};
SmoothLights make_smooth_lights(std::span<const TestLight> lights,
                                const DensitySpace* between = nullptr);

/// Adds an estimate of the irradiance without suns, times Ft, from sixteen
/// cosine-distributed rays. `u`: random, in [0, 1)^2. Unbiased. Returns the number of rays.
std::uint64_t add_smooth_irradiance(const RayScene& rays, const SmoothLights& lights,
                                    const Receiver& receiver, double eta, glm::vec2 u,
                                    std::span<double> irradiance);

/// Adds `factor` times the radiance without suns from one direction, unit, where nothing stands
/// before it. Returns the number of rays.
std::uint64_t add_smooth_radiance(const RayScene& rays, const SmoothLights& lights,
                                  const Receiver& receiver, glm::vec3 direction, double factor,
                                  std::span<double> radiance);

/// True reflected luminance of opaque receivers with albedo 1: rays to the suns, dense quadrature
/// of all other light.
struct ReflectionTruth {
    DirectionSet directions;
    SunRays suns;
    std::span<const TestLight> lights;
};
/// `lights` must outlive the result.
ReflectionTruth make_reflection_truth(std::span<const TestLight> lights,
                                      const DensitySpace* between = nullptr);
/// Both estimates are equal, because the computation is deterministic. `traced` adds up.
TwoEstimates eval_reflection(const ReflectionTruth& truth, const RayScene& rays,
                             const Receiver& receiver, std::uint64_t& traced);

}  // namespace opaline::bake
