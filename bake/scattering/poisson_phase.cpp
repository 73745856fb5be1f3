#include "bake/scattering/poisson_phase.h"

#include <cmath>
#include <numbers>

namespace opaline::bake {
namespace {

// (e^(ell lambda) - 1) e^-ell without overflow.
double scattered_moment(double lambda, double ell) {
    return lambda < 0 ? std::exp(-ell) * std::expm1(ell * lambda)
                      : -std::exp(-ell * (1 - lambda)) * std::expm1(-ell * lambda);
}

}  // namespace

double scattered_share(double absorption, double ell) {
    return std::exp(-absorption) * -std::expm1(-ell);
}

double moment_after_many(double lambda, double ell) {
    return ell > 0 ? scattered_moment(lambda, ell) / -std::expm1(-ell) : lambda;
}

double moment_of_ray(double lambda, double ell) {
    return lambda * scattered_moment(lambda, ell);
}

double moment_of_source(double lambda, double ell) {
    return lambda * lambda * std::exp(-ell * (1 - lambda));
}

double eval_zonal(std::span<const double> moment, double cosine) {
    double sum = 0, before = 0, legendre = 1;
    for (std::size_t l = 0; l < moment.size(); ++l) {
        const auto degree = static_cast<double>(l);
        sum += (2 * degree + 1) * moment[l] * legendre;
        const double next = ((2 * degree + 1) * cosine * legendre - degree * before) / (degree + 1);
        before = legendre;
        legendre = next;
    }
    return sum / (4 * std::numbers::pi);
}

}  // namespace opaline::bake
