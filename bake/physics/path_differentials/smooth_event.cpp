#include "bake/physics/path_differentials/smooth_event.h"

#include <cmath>

namespace opaline::bake {

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

}  // namespace opaline::bake
