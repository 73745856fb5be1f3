#pragma once

#include <vector>

namespace opaline::runtime {

/// What a picture is made of. Both renderers run the same list on the same samples: each sample has
/// a colour and a depth (1 / distance along the view axis; 0: nothing there yet), and every pass
/// composes what it adds with both. Surfaces write colour and depth where they are nearest; the
/// background fills what is left at depth 0. A cloud layer attenuates both and adds its own light,
/// its ground hides what is behind. Volumes scatter light between the eye and the depth and come
/// last: they attenuate the colour and add their own, on both sides of the layer, whose part of the
/// colour the samples keep for them (clouds/layer_sheet.h).
enum class PicturePass { surfaces, background, layers, volumes };

/// The passes of a picture, in order, by what it has besides surfaces.
std::vector<PicturePass> list_passes(bool background, bool volumes, bool layers = false);

}  // namespace opaline::runtime
