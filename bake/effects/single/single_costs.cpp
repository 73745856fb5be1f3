#include "bake/effects/single/single_costs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/effects/single/single_knobs.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr double kGreyLookUp = 0.8, kGreyUnpacking = 0.4;  // one band to three; measured

double texels(std::uint32_t n) {
    return static_cast<double>(formats::cubemap_texels(n));
}

}  // namespace

Work light_maps_work(const SubjectCost& cost) {
    return cost.input.knobs.exact_rays
               ? Work{}
               : Work{0, cost.facts.triangles *
                             cost.input.rates.body_triangle.at(cost.input.triangles)};
}

Work single_rows_work(const SubjectCost& cost) {
    const CostInput& input = cost.input;
    const MaterialFacts& facts = cost.facts;
    const std::uint32_t terms = cost.layout.harmonics;
    const double receivers = cost.receivers;
    const Rates& rates = input.rates;
    const bool grey = cost.layout.bands() == 1;
    const double coarse = texels(whole(input.knobs, kSingleCubemap));
    const double nodes = receivers * input.knobs[kDepthSamples];
    const double unpacked =
        receivers * terms * coarse * rates.unpack_texel * (grey ? kGreyUnpacking : 1);
    if (input.knobs.exact_rays) {
        constexpr double kRaysPerTexel = 4, kRaysPerPacket = 16;
        return {0, nodes * coarse * kRaysPerTexel / kRaysPerPacket *
                           rates.entry_packet.at(input.triangles) +
                       unpacked};
    }
    // Each batch renders all views anew.
    const double batches = std::ceil(receivers * coarse * terms * (grey ? 2 : 4) / kBatchBytes);
    const double edge =
        std::sqrt(facts.area / std::max(facts.triangles, 1.0) * 4 / std::numbers::sqrt3);
    const double pixels = std::pow(
        std::clamp(
            edge > 0 ? 4 * static_cast<double>(glm::length(facts.high - facts.low)) / edge : 128.0,
            128.0, 2048.0),
        2);
    const double view = input.triangles * rates.draw_triangle + pixels * rates.draw_pixel;
    return {0, receivers * rates.place_nodes.at(input.triangles) + batches * coarse * view +
                   nodes * coarse * (grey ? kGreyLookUp : 1) *
                       (rates.look_up.at(input.triangles) + (terms - 1) * rates.look_up_term) +
                   unpacked};
}

Work single_truth_work(const SubjectCost& cost, double depth_samples) {
    constexpr double kPackets = 97;  // true_single.cpp: a cube map of 8, and the suns
    return {0, cost.receivers * depth_samples * kPackets *
                   cost.input.rates.entry_packet.at(cost.input.triangles)};
}

}  // namespace opaline::bake
