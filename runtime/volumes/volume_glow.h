#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/volumes.h"
#include "runtime/volumes/volume_lattice.h"

namespace opaline::runtime {

/// Light that a volume sends out by itself, ready for rays.
struct VolumeGlow {
    std::vector<std::uint32_t> place;  ///< of each brick of the volume: its number among `code`, or
                                       ///< kNoBrick; empty: the volume does not glow
    std::span<const std::uint32_t> code;  ///< 512 a brick, shared_exponent.h
    float scale = 0;                      ///< of codes

    bool empty() const { return place.empty(); }
};

/// Precondition: the asset passed read_opal's checks.
VolumeGlow make_glow(const formats::VolumesView& volumes, std::size_t volume);

/// Radiance per metre [W m^-3 sr^-1] of the emitter as authored, trilinear, at a point of the
/// block's brick; `at` as density_at's. Precondition: not empty().
formats::Rgb glow_at(const VolumeGlow& glow, const BrickBlock& block, std::array<float, 3> at);

}  // namespace opaline::runtime
