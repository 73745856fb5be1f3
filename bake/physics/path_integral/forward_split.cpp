#include "bake/physics/path_integral/forward_split.h"

#include <algorithm>
#include <cassert>

namespace opaline::bake {

ForwardSplit split_forward_peak(const PhaseSeries& series, unsigned degree) {
    assert(series.lambda.size() >= degree + 2);
    ForwardSplit split;
    split.share = std::max(series.lambda[degree + 1], 0.0);
    assert(split.share < 1);
    for (unsigned l = 0; l <= degree; ++l) {
        split.rest.lambda.push_back((series.lambda[l] - split.share) / (1 - split.share));
    }
    return split;
}

}  // namespace opaline::bake
