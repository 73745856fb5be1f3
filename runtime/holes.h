#pragma once

#include <cstdint>

#include "formats/opal/asset.h"
#include "formats/opal/holes.h"

namespace opaline::runtime {

/// Which samples of a picture see a surface that light passes in places; shaders/holes.glsl does
/// the same steps.

/// A sample of a triangle: `column` and `row` on the grid of the whole picture, `last_vertex` the
/// triangle's third one, in the whole asset's numbering.
struct HoleSample {
    std::uint32_t column = 0, row = 0, last_vertex = 0;
    float cosine = 1;  ///< of the view with the normal, its absolute value: of glass
};

/// Alpha of a point: the record's, times `vertex_alpha`, interpolated from the vertices', times its
/// image.
float alpha_at(const formats::AssetView& asset, const formats::HoleRecord& hole,
               formats::Float2 texcoord, float vertex_alpha);

/// Whether a sample sees the surface. A mask: where alpha >= cutoff. A blend: alpha of all samples,
/// and of glass what its transmittance leaves of them, spread evenly over any part of the picture
/// by the R2 sequence (Martin Roberts, 2018), shifted by triangle, so that surfaces behind each
/// other need no sorting.
bool sees_surface(const formats::HoleRecord& hole, float alpha, const HoleSample& sample);

}  // namespace opaline::runtime
