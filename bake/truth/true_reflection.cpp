#include "bake/truth/true_reflection.h"

#include <numbers>
#include <vector>

#include "bake/transport/irradiance_transport.h"

namespace opaline::bake {

ReflectionTruth make_reflection_truth(std::span<const TestLight> lights) {
    constexpr std::uint32_t kRaysPerSun = 16;
    return {make_direction_set(kTruthCubemap), make_sun_rays(lights, kRaysPerSun), lights};
}

TwoEstimates eval_reflection(const ReflectionTruth& truth, const RayScene& rays,
                             const Receiver& receiver, std::uint64_t& traced) {
    Luminance reflected(truth.lights.size());
    if (receiver.normal != glm::vec3(0)) {
        std::vector<float> dense(truth.lights.front().smooth.size());
        traced += gather_irradiance(rays, truth.directions, receiver, dense);
        traced += add_sun_irradiance(rays, truth.suns, receiver, 1, reflected);
        for (std::size_t l = 0; l < truth.lights.size(); ++l) {
            reflected[l] =
                std::numbers::inv_pi * (reflected[l] + relit(dense, truth.lights[l].smooth));
        }
    }
    return {reflected, reflected};
}

}  // namespace opaline::bake
