#pragma once

#include <vector>

#include "runtime/light_vector.h"

namespace opaline::runtime {

/// integral[3 j + band] of the light over texel j [W m^-2], 6 n n texels: make_light_vector undone.
std::vector<double> texel_integrals(const LightVector& light);

}  // namespace opaline::runtime
