#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace opaline::bake {

/// By what to multiply the rows by view of a receiver, in [0, 1], so that it is negative for no
/// view: T_0 + (w' - m n) . R >= 0 for all w' inside (README.md, "Views"), under light of which
/// every texel of the cube brings the same, as those of even light do up to their solid angles.
/// Less than 1 only where noise outweighs the rows, as where few sites stand on slivers.
/// `row`: T_0. `rows`: R, axis after axis. Both hold Haar coefficients, band by band of each
/// texel, `stride` floats per texel. `normal` unit; `mean` is m; `eta` > 0.
float limit_views(std::span<const float> row, std::span<const float> rows, std::uint32_t stride,
                  glm::vec3 normal, double mean, double eta);

}  // namespace opaline::bake
