#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "bake/effects/multiple/walks/view_fit.h"

namespace opaline::bake {

/// By what to multiply rows by view, of each degree, in [0, 1].
struct ViewLimit {
    float first = 1, second = 1;
};

/// By what to multiply the rows by view of a receiver so that it is negative for no view w' inside
/// (README.md, "Views"), under light of which every texel of the cube brings the same, as those of
/// even light do up to their solid angles. Less than 1 only where noise outweighs the rows, as
/// where few sites stand on slivers, or where light has a peak that they do not hold. Both degrees
/// alike, or, where that leaves more of it, the first by itself and of the second what then fits.
/// `row`: T_0. `rows`: one after the other, 3 or 8. Both hold Haar coefficients, band by band of
/// each texel, `stride` floats per texel. `normal` unit.
ViewLimit limit_views(std::span<const float> row, std::span<const float> rows, std::uint32_t stride,
                      glm::vec3 normal, const ViewFit& fit);

}  // namespace opaline::bake
