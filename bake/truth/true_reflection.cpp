#include "bake/effects/direct/true_direct.h"

#include <numbers>
#include <vector>

#include "bake/transport/irradiance_transport.h"

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

Work direct_truth_work(const SubjectCost& cost) {
    const double rays = count_rays(kTruthCubemap);
    return {0, cost.receivers * rays *
                   (cost.traces_rays ? cost.input.rates.coherent_ray.at(cost.input.triangles)
                                     : cost.input.rates.open_cell)};
}

}  // namespace opaline::bake
