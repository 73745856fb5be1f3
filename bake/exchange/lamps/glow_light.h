#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "bake/receivers/receiver.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/volumes.h"
#include "formats/scene.h"
#include "runtime/volumes/volume_march.h"

namespace opaline::bake {

struct Ball {
    glm::dvec3 centre{0};
    double radius = 0;  ///< [m], >= 0
};

/// Directions from a point to a ball: uniform over its cone; spread by the cosine over the horizon
/// where the cone is wider than pi, or the point is inside.
class BallDirections {
  public:
    BallDirections(const Ball& ball, const glm::dvec3& point, const glm::dvec3& normal);

    /// Unit; of two numbers in [0, 1). It may point below the horizon.
    glm::dvec3 sample(double u, double v) const;
    /// Density [1/sr] of a unit direction.
    double pdf(const glm::dvec3& direction) const;

  private:
    glm::dvec3 axis_{0};
    double cap_ = 0;  // 1 - cosine of the cone's half angle; 0: spread by the cosine
};

/// Light of one lamp that comes from volumes, as the file holds it: what one of them sends out by
/// itself, and what all of them scatter. Immutable; refers to the file's arrays.
struct GlowLight {
    /// A part of the volumes, and how much light it sends out, beside others.
    struct Part {
        Ball ball;
        double power = 0;  ///< > 0
    };
    std::unique_ptr<runtime::VolumeLight> light;  ///< `lit` refers to it
    runtime::LitVolumes lit;  ///< for rays in the scene's frame, not in the world
    Ball all;                 ///< around all of it
    std::vector<Part>
        parts;  ///< the brightest ones; those that are dark, or too small, are not there
};

/// `glow`: number of the lamp's light in the records of GLOW; `volume` of the scene sends it out,
/// or kNone. Nothing where no volume has light of it. Precondition: `volumes` are those of the
/// scene, and outlive the result.
std::optional<GlowLight> make_glow_light(const formats::Scene& scene, std::uint32_t volume,
                                         const formats::VolumesView& volumes, std::uint32_t glow,
                                         unsigned threads);

/// Radiance [nit] that a lamp's light from volumes has over `reach` [m] of a ray, at its beginning.
glm::dvec3 glow_radiance(const GlowLight& glow, const glm::dvec3& from, const glm::dvec3& direction,
                         double reach);

/// Irradiance [W m^-2] of a receiver: rays in the cones of the ball around all volumes and of their
/// parts, these by power over squared distance, march through the volumes up to the first surface,
///
///     E = sum over rays of cos L(ray) / (N_all p_all + N_parts p_parts)      .
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
