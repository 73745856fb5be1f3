#pragma once

#include <cstdint>
#include <span>

#include "formats/opal/rgb.h"
#include "runtime/clouds/see_layer.h"
#include "runtime/picture/band.h"
#include "runtime/picture/camera.h"

namespace opaline::runtime {

/// A cloud layer with its ground and sky in a picture.
struct LayerPass {
    LayerScene scene;
    const Camera& camera;
    CameraFrame frame;
    std::uint32_t supersampling = 1;  ///< S: the samples of a pixel are S x S
};

/// What the pass writes, a value for each sample of a band.
struct LayerSamples {
    std::span<formats::Rgb> color;
    /// How much of that is the layer, and where it is, for passes that compose with it; empty:
    /// not asked for.
    std::span<LayerSheet> sheet;
};

/// Composes layer and ground with what each sample sees: the surface at band.inverse_distance,
/// whose color stays as far as it is seen, or the sky where that is 0, which replaces the color.
/// The ground hides what is behind it. Where a pixel sees no surface and its four corners agree to
/// kCornerTolerance, no sun touches it, and its samples get the mean of the corners. Precondition:
/// the band holds whole pixels.
void draw_layers(const LayerPass& pass, const Band& band, const LayerSamples& samples);
inline constexpr float kCornerTolerance = 0.08f;  ///< of the brightest corner

}  // namespace opaline::runtime
