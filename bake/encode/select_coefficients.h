#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// Non-linear approximation of transport vectors after [Ng2003] (encode/README.md).
struct Selector {
    std::uint32_t cubemap_size = 0;
    std::uint32_t kept = 0;     ///< M per row, the six face averages included
    std::vector<float> weight;  ///< side^beta of each coefficient's support; face averages: 0
};

/// `area_prior` is beta in [0, 1]: 0 keeps the L2-optimal coefficients. Larger values prefer coarse
/// ones, which natural light excites more.
Selector make_selector(std::uint32_t cubemap_size, std::uint32_t kept, float area_prior = 0.5f);

/// Keeps the face averages and the `kept` - 6 details that score highest,
///     score_k = weight_k sqrt(sum over bands of (luminance share T_k)^2),
/// ties by index; exact zeros are never kept. `coefficients`: `bands` Haar-transformed cube maps
/// one after the other. If one of them is NaN or infinite, the row has no details and its
/// averages are NaN.
formats::SparseRow select_coefficients(const Selector& selector,
                                       std::span<const float> coefficients, std::uint32_t bands);

/// Returns an error that names `stage` and the first receiver with a NaN or infinite coefficient.
/// Each receiver has `terms` rows of `bands` bands. Errors: bad_input.
formats::Status require_finite(const formats::SparseRows& rows, std::uint32_t terms,
                               std::uint32_t bands, const std::string& stage);

}  // namespace opaline::bake
