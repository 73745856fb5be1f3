#pragma once

#include <limits>

#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/physics/path_differentials/path_differential.h"
#include "tests/bake/path_differentials/primal.h"

namespace opaline::tests {

inline const glm::dvec3 kUp(0, 1, 0), kStill(0);

/// Steps of paths among `samples`, 1: whole domains; not limited by gradients.
inline bake::DifferentialRules unlimited_rules(double samples = 1, double extent = 1e6) {
    return {samples, std::numeric_limits<double>::infinity(), extent};
}

/// Row k0 of the table: from an eye by a glossy sphere of radius 1 to the floor.
struct GlossyChain {
    glm::dvec3 eye{0, 1, 4}, center{0.1, 1, 0}, floor{0, -0.5, 0};
    double exponent = 40;
    std::array<double, 4> x{0.02, -0.1, 0.299947635650355, 0.8324786684704146};
};

template <class S>
struct ChainEnd {
    Vector<S> P;
    S lnW;  ///< lobe times cosine
};

/// x and y move the ray by (x, y, -1), u and v choose a direction in the lobe around its
/// reflection. The frame is that of `axis`, turned along: paths nearby do not spin around it.
template <class S>
ChainEnd<S> trace_chain(const GlossyChain& chain, const std::array<S, 4>& x,
                        const glm::dvec3& axis) {
    using std::log;
    const Vector<S> eye(chain.eye), D = normalized(Vector<S>{x[0], x[1], S(-1)});
    const Vector<S> P = eye + sphere_distance<S>(eye, D, chain.center, 1) * D;
    const Vector<S> N = P - Vector<S>(chain.center), R = mirrored(D, N), from(axis);
    const auto turned = [&](const glm::dvec3& side) {
        const Vector<S> v(side), around = cross(from, R);
        const S c = dot(from, R);
        return c * v + cross(around, v) + (dot(around, v) / (S(1) + c)) * around;
    };
    const Vector<S> in_lobe = lobe_direction<S>(
        concentric_point(x[2], x[3]), [&](S q) { return power_cosine(chain.exponent, q); });
    const glm::dmat3 frame = bake::frame_around(axis);
    const Vector<S> out = in_frame<S>({turned(frame[0]), turned(frame[1])}, R, in_lobe);
    const S down = plane_distance<S>(P, out, kUp, chain.floor);
    return {P + down * out, S(chain.exponent) * log(in_lobe.z) + log(dot(N, out))};
}

/// The axis of the chain's own lobe.
inline glm::dvec3 lobe_axis(const GlossyChain& chain) {
    const glm::dvec3 D = glm::normalize(glm::dvec3(chain.x[0], chain.x[1], -1));
    const double t = sphere_distance<double>(chain.eye, D, chain.center, 1);
    return bake::make_mirror(D, chain.eye + t * D - chain.center).reflected;
}

}  // namespace opaline::tests
