#include "bake/plan/stage_work.h"

#include <cmath>

#include "bake/lights/test_lights.h"
#include "bake/trace/bake_openness.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr double kEncodeColour = 8.1e-9;  // three bands at once, transformed already: a texel
constexpr CostBySize kOpennessSeconds{5.1e-5, 9e-5};  // of a receiver

double texels(std::uint32_t n) {
    return static_cast<double>(formats::cubemap_texels(n));
}

}  // namespace

double StageRates::factor(const std::string& kind) const {
    if (const auto known = kinds.find(kind); known != kinds.end()) return known->second.factor;
    double sum = 0;
    for (const auto& [name, learnt] : kinds) {
        sum += std::log(learnt.factor);
    }
    return kinds.empty() ? 1 : std::exp(sum / static_cast<double>(kinds.size()));
}

double count_rays(std::uint32_t cubemap_size) {
    return 2 * texels(cubemap_size);
}

Work irradiance_work(const CostInput& input, double receivers, bool occluded) {
    // Scenes took 1 to 2.2 times what the ball did that was measured: rays of some pass closer
    // by more.
    constexpr double kClutter = 1.5;
    const double ray = occluded ? kClutter * kCoherentRay.at(input.triangles) : kOpenCell;
    return {0, receivers * count_rays(input.knobs.cubemap_size) * ray};
}

Work true_irradiance_work(const SubjectCost& cost) {
    const double rays = texels(kTruthCubemap);
    return {0, cost.receivers * rays *
                   (cost.traces_rays ? kCoherentRay.at(cost.input.triangles) : kOpenCell)};
}

Work encode_work(const CostInput& input, std::uint32_t rows, std::uint32_t bands,
                 double receivers) {
    const double texel = bands == 1 ? kEncodeGrey : kEncodeColour;
    return {0, receivers * rows * texels(input.knobs.cubemap_size) * texel};
}

Work openness_work(const CostInput& input, double receivers, bool occluded) {
    const double above = 0.5 * texels(kOpennessCubemap);
    return {0, receivers * (occluded ? kOpennessSeconds.at(input.triangles) : above * kOpenCell)};
}

}  // namespace opaline::bake
