#include "bake/translucent/local_stage.h"

#include <numbers>

#include "bake/scattering/fresnel.h"
#include "bake/single/entry.h"
#include "bake/single/path_quadrature.h"
#include "bake/visibility/banded_irradiance.h"

namespace opaline::bake {

LocalStage make_local_stage(const formats::Medium& medium, const MediumProfile* multiple,
                            bool single, std::uint32_t cubemap_size, std::uint32_t bands) {
    constexpr std::uint32_t kSteps = 1024;
    constexpr double kIsotropic = 0.25 * std::numbers::inv_pi;
    LocalStage stage;
    stage.directions = make_direction_set(cubemap_size);
    const PathMedium path = make_path_medium(medium);
    const auto eta = static_cast<double>(medium.eta);
    const Interface<double> boundary{eta, medium.fidelity != formats::Medium::Fidelity::paper};
    stage.factor.resize(bands);
    for (std::size_t b = 0; b < bands; ++b) {
        const double albedo = path.sigma_t[b] > 0 ? path.sigma_s[b] / path.sigma_t[b] : 0;
        for (std::uint32_t i = 0; i <= kSteps; ++i) {
            const double cosine = static_cast<double>(i) / kSteps;
            double factor = 0;
            if (multiple != nullptr) {
                factor += multiple->total(b) * fresnel_transmittance(cosine, eta) /
                          (std::numbers::pi * multiple->exit);
            }
            if (single && cosine > 0) {
                const Entry<double> entry = enter(cosine, boundary);
                factor += kIsotropic * albedo * entry.throughput / cosine * entry.refracted_cosine /
                          (1 + entry.refracted_cosine);
            }
            stage.factor[b].push_back(static_cast<float>(factor));
        }
    }
    return stage;
}

std::uint64_t gather_local(const RayScene& rays, const LocalStage& stage, const Receiver& receiver,
                           std::span<float> row) {
    return gather_banded_irradiance(rays, stage.directions, receiver, stage.factor, row);
}

}  // namespace opaline::bake
