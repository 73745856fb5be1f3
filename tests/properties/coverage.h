#pragma once

#include <optional>

#include "tests/properties/things.h"

namespace opaline::tests {

/// How far a bake errs beside path tracing, and how far it states that it errs.
struct StatedBeside {
    double found = 0;        ///< relative RMS at receivers, under the published lights
    double found_least = 0;  ///< lower end of its interval
    double stated_most = 0;  ///< upper end of the stated error's interval
    bool covers() const { return found_least <= stated_most; }
};

/// Nothing where path tracing has nothing to compare: no receiver, no light, or a bake that fails.
std::optional<StatedBeside> compare_with_reference(const SceneWords& words);

}  // namespace opaline::tests
