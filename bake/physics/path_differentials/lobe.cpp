#include "bake/physics/path_differentials/lobe.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace opaline::bake {
namespace {

/// d(h / |h|) for a change dh.
glm::dvec3 turned_by(const glm::dvec3& direction, double length, const glm::dvec3& dh) {
    return (dh - direction * glm::dot(direction, dh)) / length;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

LobePoint eval_power(double exponent, double q) {
    if (q >= 1) {  // the horizon, where the density ends but for S = 0
        return {.cosine = 0,
                .square_sine_over_q = 1,
                .dcosine = exponent > 0 ? -kInfinity : -1,
                .dln_pdf = exponent > 0 ? -kInfinity : 0};
    }
    const double n = exponent + 1, log_cosine = std::log1p(-q) / n;
    const double per_share = exponent == 0 ? 1 : std::exp(-exponent * log_cosine);  // c / (1 - q)
    return {.cosine = std::exp(log_cosine),
            .square_sine_over_q = q > 0 ? -std::expm1(2 * log_cosine) / q : 2 / n,
            .dcosine = -per_share / n,
            .dln_pdf = -exponent / (n * (1 - q))};
}

/// [Henyey1941], inverted without division by g: q runs from the forward direction.
LobePoint eval_henyey_greenstein(double g, double q) {
    const double k = 1 - 2 * q, a = 1 + g * k, a2 = a * a;
    const double narrow = (1 - g) * (1 - g), wide = (1 + g) * (1 + g);
    const double per_q = narrow * (2 + g + g * k) / a2;                // (1 - c) / q
    const double one_plus = wide * (1 - q) * (2 - g + g * k) / a2;     // 1 + c
    const double one_minus = per_q * q, product = narrow * wide / a2;  // (1 - g^2)^2 / a^2
    return {.cosine = one_minus < 1 ? 1 - one_minus : one_plus - 1,
            .square_sine_over_q = per_q * one_plus,
            .dcosine = -2 * product / a,
            .dln_pdf = -6 * g / a};
}

LobePoint eval_cap(double height, double q) {
    return {.cosine = 1 - height * q,
            .square_sine_over_q = height * (2 - height * q),
            .dcosine = -height,
            .dln_pdf = 0};
}

}  // namespace

VisibleNormal sample_visible_normal(const glm::dvec3& w_i, const MicrofacetWidths& widths, double u,
                                    double v) {
    const glm::dvec3 widen(widths.x, widths.y, 1);
    const glm::dvec3 stretched = widen * w_i;
    const double length = glm::length(stretched);
    const glm::dvec3 w = stretched / length;
    const double height = 1 + w.z;
    const LobeDirection cap = sample_lobe({Lobe::Kind::cap, height}, u, v);
    const DiskPoint disk = map_to_disk(u, v);
    const glm::dvec3 half = widen * (cap.D + w);  // not unit
    const double half_length = glm::length(half);
    VisibleNormal normal{.m = half / half_length};
    const auto column = [&](const glm::dvec3& dh) {
        return turned_by(normal.m, half_length, widen * dh);
    };
    normal.dm_du = column(cap.dD_du);
    normal.dm_dv = column(cap.dD_dv);
    // At fixed (u, v) the cap moves with its height: dc_z = -q dK, and its sine s = sqrt(K q
    // (2 - K q)) by (1 - K q) q dK / s, along the point of the disk.
    const double stretch = std::sqrt(height * (2 - height * disk.q));
    const glm::dvec3 dcap((1 - height * disk.q) * disk.radius / stretch * disk.outward, -disk.q);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 dwi(0);
        dwi[axis] = widen[axis];
        const glm::dvec3 dw = turned_by(w, length, dwi);
        normal.dm_dwi[axis] = column(dw.z * dcap + dw);
    }
    return normal;
}

// The larger coordinate is the radius, with its sign; the other one over it turns by 45 degrees at
// most.
DiskPoint map_to_disk(double u, double v) {
    constexpr double kPi = std::numbers::pi;
    const double a = 2 * u - 1, b = 2 * v - 1;
    const bool by_a = std::abs(a) > std::abs(b) || (a == 0 && b == 0);
    const double r = by_a ? a : b, other = by_a ? b : a;
    const double k = r != 0 ? other / r : 0, sign = r < 0 ? -1 : 1;
    const double phi = by_a ? kPi / 4 * k : kPi / 2 - kPi / 4 * k;
    // Of b alone the azimuth falls as a grows: the turn has the other sign.
    const double turn = by_a ? 1 : -1;
    const DiskColumn along{4 * r, 2 * sign, -turn * kPi / 2 * k * sign};
    const DiskColumn across{0, 0, turn * kPi / 2 * sign};
    return {r * r, std::abs(r), sign * glm::dvec2(std::cos(phi), std::sin(phi)),
            by_a ? along : across, by_a ? across : along};
}

LobePoint eval_lobe(const Lobe& lobe, double q) {
    switch (lobe.kind) {
        case Lobe::Kind::power:
            return eval_power(lobe.parameter, q);
        case Lobe::Kind::henyey_greenstein:
            return eval_henyey_greenstein(lobe.parameter, q);
        case Lobe::Kind::cone:
            return eval_cap(1 - lobe.parameter, q);
        case Lobe::Kind::cap:
            break;
    }
    return eval_cap(lobe.parameter, q);
}

LobeDirection sample_lobe(const Lobe& lobe, double u, double v) {
    const DiskPoint disk = map_to_disk(u, v);
    const LobePoint at = eval_lobe(lobe, disk.q);
    const double stretch = std::sqrt(at.square_sine_over_q);  // sine over radius, finite at q = 0
    const glm::dvec2 e = disk.outward, across(-e.y, e.x);
    const auto column = [&](const DiskColumn& by) {
        const double dsine = -2 * at.cosine * at.dcosine * by.radial / stretch;
        return glm::dvec3(stretch * by.tangential * across + dsine * e, at.dcosine * by.dq);
    };
    return {.D = glm::dvec3(stretch * disk.radius * e, at.cosine),
            .dD_du = column(disk.du),
            .dD_dv = column(disk.dv),
            .dln_pdf_du = at.dln_pdf * disk.du.dq,
            .dln_pdf_dv = at.dln_pdf * disk.dv.dq};
}

}  // namespace opaline::bake
