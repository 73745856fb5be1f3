#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/encode/select_coefficients.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// Which rows share a number of details, and how much an error of each shows.
struct DetailPools {
    std::vector<std::uint32_t> pool;  ///< of each row
    std::vector<float> weight;        ///< of each row, finite, >= 0
    std::vector<std::size_t> most;    ///< details that the rows of each pool keep together
};

/// The rows with those details of each pool that score highest,
///     score = weight of the row * score of select_coefficients,
/// which minimises the weighted error of all rows together for that many details: the next detail
/// of any row of a pool would reduce it equally. Ties go to the first; details with a score of 0
/// are dropped. Averages and scales stay. `selector`: of the same cube map; every row has `bands`
/// bands.
formats::SparseRows share_details(const formats::SparseRows& rows, std::uint32_t bands,
                                  const Selector& selector, const DetailPools& pools);

}  // namespace opaline::bake
