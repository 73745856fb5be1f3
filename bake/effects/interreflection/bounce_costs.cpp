#include "bake/effects/interreflection/bounce_costs.h"

#include <algorithm>
#include <vector>

#include "bake/effects/interreflection/bounce_gather.h"
#include "bake/effects/interreflection/bounce_light.h"
#include "bake/effects/interreflection/interreflection_knobs.h"
#include "bake/effects/interreflection/scatterers.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr CostBySize kBounceRay{2.1e-7, 3.9e-7};  // to the nearest surface, and its cluster
constexpr double kBounceCell = 2.3e-10;           // one number of a cluster into a receiver's row
// Rays that meet something, and clusters that they meet: statues on floors. An open scene has
// fewer.
constexpr double kHitShare = 0.44, kClustersPerHit = 4;
constexpr double kBounces = 6;
// Shares measured on the statue on its floor: receivers that trace rays of their own where there
// are sites, sites that a receiver reads, and sites added where the first level is too sparse.
constexpr double kOwnShare = 0.26, kSitesRead = 20, kAddedShare = 0.16;

double count_sites(double receivers) {
    constexpr auto kFirst = static_cast<double>(kMostSites);
    return receivers < static_cast<double>(kFewestWithSites) ? 0
           : receivers < kFirst                              ? receivers
                                : kFirst + kAddedShare * (receivers - kFirst);
}

double row_cells(std::uint32_t bands) {
    return static_cast<double>(bands * formats::cubemap_texels(kBounceCubemap));
}

double ray_work(const CostInput& input, double rays, double bands) {
    return rays * (kBounceRay.at(input.triangles) +
                   kHitShare * kClustersPerHit * row_cells(static_cast<std::uint32_t>(bands)) *
                       kBounceCell);
}

}  // namespace

Work bounce_rows_work(const SubjectCost& cost) {
    const double sides = cost.layout.sheet ? 2 : 1;
    // The light of a medium arrives at its samples instead of its receivers.
    const double rays = cost.layout.translucent && !cost.layout.at_entry
                            ? kRaysOfAveraged
                            : count_bounce_rays(cost.input.knobs[kBounceRays]);
    const std::uint32_t bands = cost.layout.coloured ? 3 : 1;
    // Sites lie among receivers: the backs of sheets have none.
    double own = sides * cost.receivers, read = 0;
    if (cost.input.receivers >= static_cast<double>(kFewestWithSites)) {
        read = (1 - kOwnShare) * cost.receivers;
        own -= read;
    }
    return {0, ray_work(cost.input, own * rays, bands) +
                   read * kSitesRead * row_cells(bands) * kBounceCell};
}

LightWork bounce_light_work(const CostInput& input) {
    const auto scatterers = static_cast<double>(count_scatterers(input.knobs));
    LightWork work;
    work.cubemap_size = kBounceCubemap;
    work.points = scatterers;
    const double texel_rays = count_rays(kBounceCubemap);
    work.work.shared += scatterers * texel_rays * kCoherentRay.at(input.triangles);
    work.work.shared += ray_work(input, scatterers * kRaysOfScatterer, 3);
    // Rows of nodes; of scatterers without bounces and with them, which the system keeps though
    // they go; nodes that rays of scatterers meet.
    constexpr double kCodeBytes = 2;
    const double row = kCodeBytes * row_cells(3);
    work.bytes = scatterers * (4 * row + kRaysOfScatterer * kHitShare * sizeof(NodeWeight));
    const double sites = count_sites(input.receivers);
    work.bytes += sites * row;
    work.work.shared +=
        ray_work(input, sites * count_rays_of_site(count_bounce_rays(input.knobs[kBounceRays])), 3);
    work.work.shared +=
        (kBounces - 1) * scatterers * kRaysOfScatterer * kHitShare * row_cells(3) * kBounceCell;
    return work;
}

}  // namespace opaline::bake
