#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

/// Small bright lights. Smooth light is scattered by a polynomial of degree 4; the suns split off
/// here by the phase function itself.
inline constexpr std::size_t kMaxSuns = 8;

/// The light of a bright texel, or a share of it.
struct Sun {
    std::uint32_t texel = 0;
    formats::Vec3 direction;        ///< unit, toward the light, world
    std::array<double, 3> light{};  ///< radiance times solid angle [W m^-2], RGB; finite
};

/// A light as suns and the rest; together they are the whole.
struct SplitLight {
    std::vector<Sun> sun;      ///< at most kMaxSuns, by texel
    std::vector<double> rest;  ///< integral[3 j + band] over texel j [W m^-2]
};

/// Texels brighter than the threshold, the larger of 1/128 of the whole luminance and the ninth
/// brightest texel, give a share of their light to a sun: 0 at the threshold, all from twice the
/// threshold on, linear between. So both parts are continuous functions of the light. A small light
/// fills the four texels around it (integrate_discs.h): the direction of a sun is the mean over all
/// suns less than 3 / n rad away, weighted by luminance, which is that of the light itself. Light
/// that is not finite stays in the rest. `integral`: texel_integrals.h; n x n texels a face.
SplitLight split_suns(std::span<const double> integral, std::uint32_t n);

/// The light vector of a sun alone.
LightVector make_sun_light(const Sun& sun, std::uint32_t n);

/// True if suns would change what is seen of a volume: it shows single scattering, and the
/// polynomial of its moments is off its phase function by more than 1 % of 1/(4 pi) somewhere.
/// `phase`: the volume's, kPhaseEntries values.
bool needs_suns(const formats::VolumeRecord& record, std::span<const float> phase);

}  // namespace opaline::runtime
