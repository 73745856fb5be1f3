#pragma once

#include "bake/effects/multiple/multiple_stage.h"
#include "bake/plan/dense_rows.h"
#include "bake/plan/row_layout.h"

namespace opaline::bake {

/// T_0 += T_d / (pi c_exit h_0). Where the layout has rows by view, adds the walked light to them
/// as harmonics of the view w'. `tolerance` of the gather; `layout` and `row` of the stage's
/// material.
void add_multiple_rows(const MultipleStage& stage, const BodyPoint& point, double tolerance,
                       const RowLayout& layout, const DenseRow& row);

}  // namespace opaline::bake
