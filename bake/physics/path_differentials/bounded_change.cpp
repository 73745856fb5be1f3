#include "bake/physics/path_differentials/bounded_change.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::bake {
namespace {

/// A secant leaves the tangent plane of the unit sphere; what it has along the direction moves no
/// later vertex.
glm::dvec3 across(const glm::dvec3& direction, const glm::dvec3& change) {
    return change - direction * glm::dot(direction, change);
}

}  // namespace

Mirror make_mirror(const glm::dvec3& D, const glm::dvec3& N) {
    const double k = glm::dot(D, N);
    return {D, N, k, D - 2 * k * N};
}

std::optional<Refraction> make_refraction(const glm::dvec3& D, const glm::dvec3& N, double eta) {
    const Mirror mirror = make_mirror(D, N);
    const double square = 1 - eta * eta * (1 - mirror.k * mirror.k);
    if (!(square > 0)) return std::nullopt;
    const double c_t = std::sqrt(square);
    return Refraction{mirror, eta, c_t, eta * D - (eta * mirror.k + c_t) * N};
}

glm::dvec3 bounded_transfer(const glm::dvec3& D, const glm::dvec3& N_g, double t,
                            const glm::dvec3& dP, const glm::dvec3& dD) {
    const glm::dvec3 w = dP + t * dD;
    const double facing = glm::dot(N_g, D), least = kLeastGrazing * glm::length(D);
    const double divisor = std::abs(facing) < least ? std::copysign(least, facing) : facing;
    const glm::dvec3 moved = w - D * (glm::dot(N_g, w) / divisor);
    return moved - N_g * glm::dot(N_g, moved);
}

double sqrt_secant(double z, double d) {
    const double half = std::abs(d) / 2, upper = std::sqrt(z + half);
    if (half > z) return std::copysign(upper, d);
    const double sum = upper + std::sqrt(z - half);
    return sum > 0 ? d / sum : 0;
}

glm::dvec3 bounded_refraction(const Refraction& event, const glm::dvec3& dD, const glm::dvec3& dN,
                              double step) {
    const double change = event.square_cosine_change(event.mirror.cosine_change(dD, dN));
    const double dc_t = sqrt_secant(event.c_t * event.c_t, step * change) / step;
    return across(event.refracted, event.change_by(dD, dN, dc_t));
}

glm::dvec3 bounded_direction(const glm::dvec3& column, double step) {
    const double chord = step * glm::length(column);
    return chord > std::numbers::sqrt2 ? column * (std::numbers::sqrt2 / chord) : column;
}

LobeDirection secant_of_lobe(const Lobe& lobe, double u, double v, double step) {
    const DiskPoint disk = map_to_disk(u, v);
    const LobePoint middle = eval_lobe(lobe, disk.q);
    const double stretch = std::sqrt(middle.square_sine_over_q);
    const glm::dvec3 outward(disk.outward, 0), around(-disk.outward.y, disk.outward.x, 0);
    const glm::dvec3 D = stretch * disk.radius * outward + glm::dvec3(0, 0, middle.cosine);
    // At a signed radius: the map goes on through the middle.
    const auto at_radius = [&](double radius) {
        const LobePoint at = eval_lobe(lobe, radius * radius);
        return radius * std::sqrt(at.square_sine_over_q) * outward + glm::dvec3(0, 0, at.cosine);
    };
    const auto column = [&](const DiskColumn& by) {
        const double half = by.radial * step / 2;
        const glm::dvec3 change = stretch * by.tangential * around +
                                  (at_radius(std::clamp(disk.radius + half, -1.0, 1.0)) -
                                   at_radius(std::clamp(disk.radius - half, -1.0, 1.0))) /
                                      step;
        return bounded_direction(across(D, change), step);
    };
    return {.D = D,
            .dD_du = column(disk.du),
            .dD_dv = column(disk.dv),
            .dln_pdf_du = middle.dln_pdf * disk.du.dq,
            .dln_pdf_dv = middle.dln_pdf * disk.dv.dq};
}

}  // namespace opaline::bake
