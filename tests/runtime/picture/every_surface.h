#pragma once

#include "formats/opal/asset.h"

namespace opaline::test {

/// An asset that has every kind of surface: glossy balls for each way a lobe is summed up,
/// media of many and few terms, one band and three, in rows of their own, one that mirrors; a
/// thin-walled board, a mask, a blend; textures of colour, gloss, alpha and glow; two emitters,
/// "a" and "b".
formats::Asset make_every_surface();

}  // namespace opaline::test
