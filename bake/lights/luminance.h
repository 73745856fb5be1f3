#pragma once

#include <vector>

namespace opaline::bake {

/// Luminance under each test light.
using Luminance = std::vector<double>;

/// Two independent unbiased estimates of the truth about one receiver.
struct TwoEstimates {
    Luminance first, second;
};

}  // namespace opaline::bake
