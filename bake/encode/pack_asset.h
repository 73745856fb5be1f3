#pragma once

#include <span>
#include <vector>

#include "bake/plan/row_layout.h"
#include "formats/opal/asset.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Puts a scene's preview geometry and its finished transport rows into one asset, primitives in
/// scene order. `layouts`: one per material. `transport` has the rows of all vertices; the layout
/// of a vertex's material gives the number of rows and bands. `openness`: one per vertex, or empty
/// where no material mirrors.
formats::Asset pack_asset(const formats::Scene& scene, std::span<const RowLayout> layouts,
                          formats::SparseRows transport, std::vector<formats::Openness> openness);

}  // namespace opaline::bake
