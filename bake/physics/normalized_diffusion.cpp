#include "bake/physics/profile.h"

#include <cmath>
#include <numbers>

namespace opaline::bake {

double normalized_diffusion_shape(double albedo, DiffusionLength kind) {
    const double x = albedo - 0.8;
    switch (kind) {
        case DiffusionLength::mean_free_path_searchlight:
            return 1.85 - albedo + 7 * std::abs(x * x * x);
        case DiffusionLength::mean_free_path_diffuse:
            return 1.9 - albedo + 3.5 * x * x;
        default:
            return 3.5 + 100 * std::pow(albedo - 0.33, 4);
    }
}

NormalizedDiffusion make_normalized_diffusion(double albedo, double length, DiffusionLength kind) {
    return {albedo, length / normalized_diffusion_shape(albedo, kind)};
}

double eval_normalized_diffusion(const NormalizedDiffusion& profile, double r) {
    const double x = r / profile.d;
    return profile.albedo * (std::exp(-x) + std::exp(-x / 3)) /
           (8 * std::numbers::pi * profile.d * r);
}

double normalized_diffusion_within(const NormalizedDiffusion& profile, double a) {
    // 1 - e^-x / 4 - 3 e^(-x/3) / 4, without cancellation for small a.
    const double x = a / profile.d;
    return -profile.albedo * (0.25 * std::expm1(-x) + 0.75 * std::expm1(-x / 3));
}

}  // namespace opaline::bake
