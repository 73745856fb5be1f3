#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/environment.h"
#include "runtime/light_vector.h"
#include "runtime/lookup_map.h"
#include "runtime/project_small_sources.h"

namespace opaline::runtime {

/// How finely a map is sampled.
enum class MapSampling {
    full,   ///< what photographic maps can tell apart
    moving  ///< for lights that turn from frame to frame: a tenth of the samples
};

/// What integrate_map needs of a map, whatever the rotation, so that turning a light costs neither
/// the map's reduction nor a copy of it.
struct PreparedMap {
    std::uint32_t n = 0;               ///< of the cube map to integrate over
    std::uint32_t samples = 0;         ///< per side of a texel
    LookupMap lookup;                  ///< without `bright`
    formats::Environment shape;        ///< of the map in `lookup`, without pixels
    std::vector<BrightPixel> bright;   ///< to be added one by one
    std::vector<SmallSource> sources;  ///< the same as points
    std::vector<double> solid_angle;   ///< of the texels of a face
    std::vector<double> boxes;  ///< exact integrals of an unturned cube map; empty for other maps
};

/// Preconditions and threads as for project_environment. Discs are left out.
PreparedMap prepare_map(const formats::Environment& map, std::uint32_t n, unsigned threads);

/// Adds the integral of a map's radiance over each of the 6 n n texels, integral[3 j + band]
/// [W m^-2]; discs are left out. Preconditions and threads as for project_environment. Allocates
/// nothing with MapSampling::moving on one thread.
///
/// - A cube map whose size is a multiple of n, turned by quarter turns or not at all: its pixels
///   are summed by exact solid angle.
/// - Other maps: the bilinear map is sampled at s x s points of each texel. Their mean, weighted by
///   solid angle, is multiplied with the texel's exact one, so that a constant map gives the
///   texels' solid angles to rounding. n s <= 1024; finer maps are first reduced
///   (reduce_map.h).
/// - A grid of points misjudges pixels that are smaller than a texel and much brighter than their
///   surroundings (a sun in the map). Such pixels are subtracted from the map first and added one
///   by one with their exact flux (project_small_sources.h).
/// - MapSampling::moving: n s <= 320 (384 for n = 128), and bright pixels are added as points. The
///   integrals differ by up to a percent of their norm where light has sharp edges (tested).
void integrate_map(const PreparedMap& map, MapSampling sampling, const Rotation& rotation,
                   unsigned threads, std::span<double> integral);

/// Both, with MapSampling::full.
void integrate_map(const formats::Environment& map, std::uint32_t n, const Rotation& rotation,
                   unsigned threads, std::span<double> integral);

}  // namespace opaline::runtime
