#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/plan/row_layout.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The share of light scattered once in the reflectance of a half space under uniform light,
/// largest over the bands; in [0, 1].
double share_scattered_once(const formats::Medium& medium);

/// Of all that light the relative RMS that so many terms of the phase function, seen as harmonics
/// of the view, leave wrong (phase_rms_relative); `terms` in [0, 25].
double once_error(const formats::Medium& medium, unsigned terms);

/// Weights of a receiver's rows in the radiosity that leaves a medium,
///     B = sum_k g_k T_k,   g_k = int F_t(eta, n.w) (n.w) h_k(w') dw,
/// w' the direction inside that w refracts from: by a product rule over the hemisphere.
/// `layout`: with the rows of a medium. `eta` > 0. One weight for each of its terms.
std::vector<float> weigh_rows_of_medium(const RowLayout& layout, float eta, glm::vec3 normal);

}  // namespace opaline::bake
