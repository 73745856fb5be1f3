#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// A phase function, ready to be sampled.
struct PhaseTable {
    formats::PhaseFunction::Type type = formats::PhaseFunction::Type::isotropic;
    double g = 0;  ///< of Henyey-Greenstein
    /// Others: cosines at equal steps of the cumulative distribution, from 1 to -1.
    std::vector<float> cosine;
};

/// Precondition: the phase function is within the bounds of formats/scene.h.
PhaseTable make_phase_table(const formats::PhaseFunction& phase);

double mean_cosine(const PhaseTable& table);

/// Cosine between the propagation directions before and after a scattering event, distributed as
/// 2 pi p(cosine); `u` uniform in [0, 1). Exact for isotropic and Henyey-Greenstein functions;
/// others are resolved in 4096 steps of equal probability.
float sample_cosine(const PhaseTable& table, float u);

/// The direction after a scattering event, unit; `u` and `v` uniform in [0, 1).
glm::vec3 scatter(const PhaseTable& table, glm::vec3 direction, float u, float v);

}  // namespace opaline::bake
