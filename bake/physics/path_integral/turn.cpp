#include "bake/physics/path_integral/turn.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"

namespace opaline::bake {
namespace {

// Below this sine two directions count as opposite; the end of the turn is off by no more.
constexpr double kOpposite = 1e-12;

}  // namespace

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

Turns::Turns(glm::dvec3 from, glm::dvec3 to) {
    // A path along a vector of length 0 would never arrive anywhere.
    assert(std::abs(glm::dot(from, from) - 1) < 1e-4 && std::abs(glm::dot(to, to) - 1) < 1e-4);
    const glm::dvec3 axis = glm::cross(from, to);
    const double sine = glm::length(axis), cosine = glm::dot(from, to);
    if (cosine < 0 && sine < kOpposite) {
        const Frame frame = make_frame(glm::vec3(from));
        const glm::dvec3 u(frame.u);
        const glm::dvec3 first = glm::normalize(u - glm::dot(u, from) * from);
        const glm::dvec3 second = glm::cross(from, first);
        count_ = 0;
        for (const glm::dvec3 aside : {first, second, -first, -second}) {
            turn_[count_++] = {from, aside, to, std::numbers::pi};
        }
        return;
    }
    const glm::dvec3 aside = sine > 0 ? glm::normalize(glm::cross(axis, from)) : glm::dvec3(0);
    // atan2 keeps its digits near 0 and pi, where acos has half of them.
    turn_[0] = {from, aside, to, std::atan2(sine, cosine)};
}

}  // namespace opaline::bake
