#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/encode/select_coefficients.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// How the rows of nodes are kept.
struct NodeEncoder {
    Selector selector;     ///< of the file's cube map; at most M coefficients a row
    double tolerance = 0;  ///< what may be lost besides: RMS, relative to a node's rows together
};

/// One row from texel values of `bands` cube maps of m x m texels. `energy`: the sum of squares
/// that the tolerance refers to, in texels of the file's cube map and per band.
formats::SparseRow encode_node_row(const NodeEncoder& encoder, std::span<const float> values,
                                   std::uint32_t m, std::uint32_t bands, double energy);

/// Sum of squares of the Haar coefficients of `values` on a file's cube map of n x n texels.
double row_energy(std::span<const float> values, std::uint32_t m, std::uint32_t n);

}  // namespace opaline::bake
