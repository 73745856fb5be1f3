#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/plan/row_layout.h"
#include "formats/scene.h"

namespace opaline::bake {

/// By material, whether its textures are filtered over the areas that a bake integrates over (its
/// decision, RowLayout::filtered; with lamps all: these have no bound). Empty: there is nothing to
/// filter. `layouts`: by material.
std::vector<std::uint8_t> filtered_materials(const formats::Scene& scene,
                                             std::span<const RowLayout> layouts, bool has_lamps);

}  // namespace opaline::bake
