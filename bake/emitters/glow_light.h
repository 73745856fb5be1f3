#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>

#include "bake/emitters/ball_directions.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/ray_scene.h"
#include "bake/volumes/density_space.h"
#include "formats/opal/volumes.h"
#include "formats/scene.h"
#include "runtime/volumes/volume_march.h"

namespace opaline::bake {

/// Light that one volume sends out by itself, as the file holds it: seen directly, and scattered by
/// all volumes. Immutable; refers to the file's arrays.
struct GlowLight {
    std::unique_ptr<runtime::VolumeLight> light;  ///< `lit` refers to it
    runtime::LitVolumes lit;  ///< for rays in the scene's frame, not in the world
    Ball own, all;            ///< around the emission; around emission and all scattering volumes
};

/// `glow`: number of the volume's light in the records of GLOW. Precondition: `volumes` holds the
/// baked scene.volumes[volume], and outlives the result.
GlowLight make_glow_light(const formats::Scene& scene, std::uint32_t volume,
                          const formats::VolumesView& volumes, std::uint32_t glow,
                          unsigned threads);

/// Irradiance [W m^-2] of a receiver: rays in the cones of both balls, weighed by the balance
/// heuristic, march through the volumes up to the first surface,
///
///     E = sum over rays of cos L(ray) / (N_own p_own + N_all p_all).
///
/// `turn`: two numbers in [0, 1) that shift the lattice of rays. `rays` counts those traced.
glm::dvec3 glow_irradiance(const GlowLight& glow, const RayScene& surfaces,
                           const Receiver& receiver, std::uint32_t samples,
                           std::array<float, 2> turn, std::uint64_t& rays);

/// Share of light that volumes leave over `reach` [m] of a ray; all of it where `volumes` is null.
glm::dvec3 volume_transmittance(const DensitySpace* volumes, const glm::dvec3& from,
                                const glm::dvec3& direction,
                                double reach = std::numeric_limits<double>::infinity());

}  // namespace opaline::bake
