#include "bake/lights/true_reflection.h"

#include <numbers>
#include <vector>

#include "bake/trace/density/attenuation.h"
#include "bake/trace/irradiance_transport.h"

namespace opaline::bake {
namespace {

// By what volumes let through to a place from the middles of coarser cells.
void dim(const DensitySpace* between, glm::vec3 to, std::span<float> dense) {
    constexpr std::uint32_t kCells = 16;
    if (between == nullptr) return;
    const LightCells cells = make_light_cells(kCells);
    std::vector<float> share(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        share[i] = static_cast<float>(let_through(between, to, cells.direction(i)));
    }
    for (std::size_t i = 0; i < dense.size(); ++i) {
        dense[i] *= share[coarser_texel(i, kTruthCubemap, kCells)];
    }
}

}  // namespace

ReflectionTruth make_reflection_truth(std::span<const TestLight> lights,
                                      const DensitySpace* between) {
    constexpr std::uint32_t kRaysPerSun = 16;
    return {make_texel_directions(kTruthCubemap), make_sun_rays(lights, kRaysPerSun, between),
            lights};
}

TwoEstimates eval_reflection(const ReflectionTruth& truth, const RayScene& rays,
                             const Receiver& receiver, std::uint64_t& traced) {
    Luminance reflected(truth.lights.size());
    if (receiver.normal != glm::vec3(0)) {
        std::vector<float> dense(truth.lights.front().smooth.size());
        traced += gather_irradiance(rays, truth.directions, receiver, dense);
        dim(truth.suns.between, receiver.origin, dense);
        traced += add_sun_irradiance(rays, truth.suns, receiver, 1, reflected);
        for (std::size_t l = 0; l < truth.lights.size(); ++l) {
            reflected[l] =
                std::numbers::inv_pi * (reflected[l] + relit(dense, truth.lights[l].smooth));
        }
    }
    return {reflected, reflected};
}

}  // namespace opaline::bake
