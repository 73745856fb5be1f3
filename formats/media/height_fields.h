#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace opaline::formats {

/// A cloud layer from a formula.
struct HeightFieldShape {
    enum class Type {
        cellular,  ///< closed cells, as stratocumulus has
        waves      ///< billows in rows, as undulatus has
    } type = Type::cellular;
    double scale = 1000;           ///< across a cell, or from crest to crest [m], > 0
    double coverage = 1;           ///< share of the area where there is cloud, in [0, 1]
    std::uint32_t seed = 1;        ///< another one: another layer of the same kind
    std::uint32_t resolution = 0;  ///< texels a side, > 0
    std::uint32_t frames = 1;      ///< of a period of evolution; 1: the layer keeps its shape
};

/// Relative thickness at the centres of `resolution` x `resolution` texels over `size` [m], x
/// fastest, frame after frame: in [0, 1], the largest of all frames is 1 (all 0 if coverage is).
/// The share of texels above 0 is the coverage in every frame, to a texel or two. Frames are even
/// steps of a period: the first one follows on the last one as each one on the one before it.
/// Continues without a seam where it is repeated: `scale` is rounded so that a whole number of
/// cells or waves, at least one, fits into `size`. The same values on every run.
std::vector<float> make_height_field(const HeightFieldShape& shape, std::array<double, 2> size);

/// The largest of these values, without them: 1 or 0.
float find_highest(const HeightFieldShape& shape);

}  // namespace opaline::formats
