#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Rows of an asset with fewer coefficients, and the primitives that say where they stand.
struct ShortRows {
    std::vector<formats::PrimitiveRecord> primitives;
    formats::SparseRows rows;

    /// The asset with these rows. Refers to both.
    formats::AssetView view_of(const formats::AssetView& asset) const;
};

/// Keeps of every row the six face averages and the `kept` - 6 details that score highest
/// (select_coefficients.h, beta = 1/2), with the codes that they have: what a bake with fewer
/// coefficients keeps, up to rounding. Rows of volumes are no part of it. Errors: bad_input
/// (primitives that share rows, which no bake writes).
formats::Result<ShortRows> shorten_rows(const formats::AssetView& asset, std::uint32_t kept);

/// The largest number of coefficients of a row of meshes, the six face averages included; 0 without
/// rows.
std::uint32_t longest_row(const formats::AssetView& asset);

}  // namespace opaline::bake
