#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/encode/select_coefficients.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// How rows of nodes are kept.
struct NodeEncoder {
    Selector selector;     ///< of the file's cube map; of some rows together M coefficients at most
    double tolerance = 0;  ///< further loss allowed: RMS, relative to these rows together
};

/// `count` rows of a node from their texel values, `bands` cube maps of m x m texels each. They
/// keep the details that are largest among all of them (Selector's scores), and in any case their
/// face averages.
std::vector<formats::SparseRow> encode_node_rows(const NodeEncoder& encoder,
                                                 std::span<const float> values, std::uint32_t count,
                                                 std::uint32_t m, std::uint32_t bands);

/// Sum of squares of the Haar coefficients of `values` on a file's cube map of n x n texels.
double row_energy(std::span<const float> values, std::uint32_t m, std::uint32_t n);

}  // namespace opaline::bake
