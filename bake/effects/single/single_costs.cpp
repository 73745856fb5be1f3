#include "bake/effects/single/single_costs.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/effects/single/single_knobs.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr double kGreyLookUp = 0.8, kGreyUnpacking = 0.4;  // one band to three; measured

// Light maps: of the mesh that they draw; into one; a pixel of one, to clear and fill.
constexpr CostBySize kBodyTriangle{2.5e-6, 3.3e-6};
constexpr double kDrawTriangle = 3.1e-8, kDrawPixel = 3.4e-9;
constexpr CostBySize kPlaceNodes{3.2e-6, 3.9e-6};  // the inward path of a receiver
// Of a node in a light map, rays for undecided nodes included; each term beyond the first.
constexpr CostBySize kLookUp{9e-8, 9e-8};
constexpr double kLookUpTerm = 9.3e-9;
constexpr double kUnpackTexel = 7.7e-9;           // from packed rows into a receiver's, per term
constexpr CostBySize kEntryPacket{6.2e-6, 1e-5};  // sixteen rays out of a body, with their entries

double texels(std::uint32_t n) {
    return static_cast<double>(formats::cubemap_texels(n));
}

}  // namespace

Work light_maps_work(const SubjectCost& cost) {
    return cost.input.knobs.exact_rays
               ? Work{}
               : Work{0, cost.facts.triangles * kBodyTriangle.at(cost.input.triangles)};
}

Work single_rows_work(const SubjectCost& cost) {
    const CostInput& input = cost.input;
    const MaterialFacts& facts = cost.facts;
    const std::uint32_t terms = cost.layout.harmonics;
    const double receivers = cost.receivers;
    const bool grey = cost.layout.bands() == 1;
    const double coarse = texels(whole(input.knobs, kSingleCubemap));
    const double nodes = receivers * input.knobs[kDepthSamples];
    const double unpacked = receivers * terms * coarse * kUnpackTexel * (grey ? kGreyUnpacking : 1);
    if (input.knobs.exact_rays) {
        constexpr double kRaysPerTexel = 4, kRaysPerPacket = 16;
        return {0,
                nodes * coarse * kRaysPerTexel / kRaysPerPacket * kEntryPacket.at(input.triangles) +
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
    const double view = input.triangles * kDrawTriangle + pixels * kDrawPixel;
    return {0, receivers * kPlaceNodes.at(input.triangles) + batches * coarse * view +
                   nodes * coarse * (grey ? kGreyLookUp : 1) *
                       (kLookUp.at(input.triangles) + (terms - 1) * kLookUpTerm) +
                   unpacked};
}

Work single_truth_work(const SubjectCost& cost, double depth_samples) {
    constexpr double kPackets = 97;  // true_single.cpp: a cube map of 8, and the suns
    return {0, cost.receivers * depth_samples * kPackets * kEntryPacket.at(cost.input.triangles)};
}

}  // namespace opaline::bake
