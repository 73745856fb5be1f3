#include "bake/measure/truth.h"

#include <numbers>
#include <vector>

#include "bake/visibility/irradiance_transport.h"

namespace opaline::bake {

DirectTruth make_direct_truth(std::span<const TestLight> lights) {
    constexpr std::uint32_t kRaysPerSun = 16;
    return {make_direction_set(kTruthCubemap), make_sun_rays(lights, kRaysPerSun)};
}

TwoEstimates eval_truth(const DirectTruth& truth, const RayScene& rays, const Receiver& receiver,
                        std::span<const TestLight> lights, std::uint64_t& traced) {
    Luminance reflected(lights.size());
    if (receiver.normal != glm::vec3(0)) {
        std::vector<float> dense(lights.front().smooth.size());
        traced += gather_irradiance(rays, truth.directions, receiver, dense);
        traced += add_sun_irradiance(rays, truth.suns, receiver, 1, reflected);
        for (std::size_t l = 0; l < lights.size(); ++l) {
            reflected[l] = std::numbers::inv_pi * (reflected[l] + relit(dense, lights[l].smooth));
        }
    }
    return {reflected, reflected};
}

TranslucentTruth make_translucent_truth(const formats::Scene& scene, std::uint32_t material,
                                        const MediumProfile* multiple, std::uint32_t depth_samples,
                                        std::span<const TestLight> lights) {
    constexpr std::uint32_t kRaysPerSun = 4;  // at a random point of many
    TranslucentTruth truth;
    truth.suns = make_sun_rays(lights, kRaysPerSun);
    truth.smooth = make_smooth_lights(lights);
    if (multiple != nullptr) {
        truth.multiple = make_surface_integral(scene, material, *multiple);
    }
    if (depth_samples > 0) {
        truth.single = make_single_quadrature(scene, material, depth_samples, lights);
    }
    return truth;
}

TwoEstimates eval_truth(const TranslucentTruth& truth, const formats::Scene& scene,
                        const RayScene& rays, const BodyPoint& point, std::uint64_t seed,
                        std::uint32_t receiver, std::uint64_t& traced) {
    const std::size_t lights = truth.smooth.lights;
    TwoEstimates estimates{Luminance(lights), Luminance(lights)};
    if (truth.multiple) {
        estimates = integrate_multiple(*truth.multiple, scene, rays, truth.suns, truth.smooth,
                                       point.position, truth.points, seed, receiver, traced);
    }
    if (truth.single && point.normal != glm::vec3(0)) {
        const Luminance once = integrate_single(*truth.single, rays, point, traced);
        for (std::size_t l = 0; l < lights; ++l) {
            estimates.first[l] += once[l];
            estimates.second[l] += once[l];
        }
    }
    return estimates;
}

}  // namespace opaline::bake
