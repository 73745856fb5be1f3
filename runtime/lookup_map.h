#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/environment.h"
#include "formats/opal/vec3.h"
#include "runtime/simd.h"

namespace opaline::runtime {

/// A map laid out for very many bilinear look-ups: four floats a pixel (r, g, b, 1), with a border
/// of one pixel all around (around each face of a cube map) that holds what lies beyond, so that
/// no look-up wraps or clamps.
struct LookupMap {
    formats::Environment::Layout layout = formats::Environment::Layout::lat_long;
    std::uint32_t width = 0, height = 0;  ///< without border; of a cube map, of one face
    float u_offset = 0.5f, u_sign = 1;
    bool rows_include_poles = false;
    std::vector<float> rgba;  ///< empty: black
};

LookupMap make_lookup_map(const formats::Environment& map);

inline constexpr std::uint32_t kMostSamples = 2048;

/// Adds up samples i = 0 ... weight.size() - 1, weight[i] * (r, g, b, 1) of the map in the
/// direction first + i * step, which may have any length but 0: as many to each of `sums` in turn.
/// As formats::sample_map, but for rounding: directions to 1e-6 rad. Partial sums have single
/// precision. Preconditions: the map is not empty; weight.size() is a multiple of sums.size() and
/// at most kMostSamples. Never allocates.
void add_row(const LookupMap& map, formats::Vec3 first, formats::Vec3 step,
             std::span<const float> weight, std::span<Double4> sums);

}  // namespace opaline::runtime
