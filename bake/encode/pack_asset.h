#pragma once

#include <span>
#include <vector>

#include "bake/plan/row_layout.h"
#include "formats/opal/asset.h"
#include "formats/opal/holes.h"
#include "formats/opal/normal_maps.h"
#include "formats/opal/preview_image.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Puts a scene's preview geometry and its finished transport rows into one asset, primitives in
/// scene order. `layouts`: one per material. `transport` has the rows of all receivers, which are
/// vertices or, if there are some, slots; the layout of their material gives the number of rows and
/// bands. `openness`: one per receiver, or empty where no material mirrors.
formats::Asset pack_asset(const formats::Scene& scene, std::span<const RowLayout> layouts,
                          formats::SparseRows transport, std::vector<formats::Openness> openness,
                          formats::Slots slots = {});

/// The holes of a scene's surfaces, as pictures need them (has_holes). Adds the alpha of their
/// images, one each, to `images`. Primitives in scene order.
formats::Holes pack_holes(const formats::Scene& scene,
                          std::vector<formats::PreviewImageData>& images);

/// The normal maps of a scene's surfaces, for pictures: rows know nothing of them. Images have the
/// scene's numbers. Primitives in scene order; maps of scale 0 are left out.
formats::NormalMaps pack_normal_maps(const formats::Scene& scene);

}  // namespace opaline::bake
