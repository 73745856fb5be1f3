#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/check/measure_error.h"
#include "bake/check/surface_probes.h"
#include "bake/lights/test_lights.h"
#include "bake/plan/row_layout.h"
#include "formats/opal/asset.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// h_k of each of a receiver's rows, seen along its normal; `behind`: of a thin-walled surface,
/// seen against it.
std::vector<float> view_of_rows(const RowLayout& layout, glm::vec3 normal, bool behind = false);

/// Rows of one receiver, as a file stores them.
struct RowSource {
    formats::SparseRowsView rows;
    formats::RowRange range;      ///< of its primitive
    std::uint32_t first_row = 0;  ///< the receiver's, counted from the start of the range
};

/// sum over a receiver's rows of h_k <T_k, L>, as the runtime evaluates it; one row for each h.
Luminance relight_rows(const RowSource& source, std::span<const float> h,
                       std::span<const TestLight> lights);

/// What the runtime shows at `point`, but for base colour and the exit's Ft: the mix of its
/// vertices, each with its own h_k, for an eye far away along the point's view. `layout`: of the
/// point's material.
Luminance relight_point(const formats::AssetView& asset, const CheckPoint& point,
                        const RowLayout& layout, std::span<const TestLight> lights);

}  // namespace opaline::bake
