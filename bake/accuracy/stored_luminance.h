#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/accuracy/measure_error.h"
#include "bake/truth/test_lights.h"
#include "bake/plan/row_layout.h"
#include "formats/opal/asset.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// h_k of each of a translucent receiver's rows, seen along its normal.
std::vector<float> view_of_rows(const RowLayout& layout, glm::vec3 normal);

/// Rows of one receiver, as a file keeps them: what measuring reads.
struct RowSource {
    formats::SparseRowsView rows;
    formats::RowRange range;      ///< of its primitive
    std::uint32_t first_row = 0;  ///< the receiver's, counted from the start of the range
};
RowSource rows_of(const formats::AssetView& asset, std::uint32_t receiver);

/// sum over a receiver's rows of h_k <T_k, L>, as the runtime would say; one row for each h.
Luminance relight_rows(const RowSource& source, std::span<const float> h,
                       std::span<const TestLight> lights);

}  // namespace opaline::bake
