#pragma once

#include <limits>

#include "bake/path_differentials/path_differential.h"
#include "tests/bake/path_differentials/glossy_chain.h"

namespace opaline::tests {

inline const glm::dvec3 kUp(0, 1, 0), kStill(0);

/// Steps that are not limited by gradients.
inline bake::DifferentialRules local_rules(double extent = 1e6) {
    return {.gradient_limit = std::numeric_limits<double>::infinity(), .extent = extent};
}
inline bake::DifferentialRules global_rules(double samples) {
    bake::DifferentialRules rules = local_rules();
    rules.steps = bake::DifferentialRules::Steps::global;
    rules.samples = samples;
    return rules;
}

// Row k0 of the table.
inline const GlossyChain kChain{{0, 1, 4}, {0.1, 1, 0}, 1, 40, -0.5};
inline const ChainPoint kPoint{0.02, -0.1, 0.3252124810254731, 0.4421682599514397};

}  // namespace opaline::tests
