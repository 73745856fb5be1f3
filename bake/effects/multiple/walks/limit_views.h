#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "bake/effects/multiple/walks/view_fit.h"

namespace opaline::bake {

/// Factors of rows by view, one a degree, in [0, 1].
struct ViewLimit {
    float first = 1, second = 1;
};

/// Factors for the rows by view of a receiver that keep it from being negative for any view w'
/// inside (README.md, "Views"), under equal light from every texel of the cube. Less than 1 only
/// where noise outweighs the rows, as on slivers with few sites, or where the light has a sharp
/// peak. Both degrees have one factor or, where that keeps more of the first, the first its own and
/// the second the largest that then fits.
/// `row`: T_0. `rows`: one after the other, 3 or 8. Both hold Haar coefficients, band by band of
/// each texel, `stride` floats per texel. `normal` unit.
ViewLimit limit_views(std::span<const float> row, std::span<const float> rows, std::uint32_t stride,
                      glm::vec3 normal, const ViewFit& fit);

}  // namespace opaline::bake
