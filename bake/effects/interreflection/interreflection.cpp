#include "bake/effects/interreflection/interreflection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/scatterers.h"
#include "bake/plan/effect.h"
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

std::uint32_t rays_of_receiver(const Knobs& knobs) {
    return count_bounce_rays(knobs[kBounceRays]);
}

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

// Of the rays and clusters of all rows of `cost.receivers` receivers.
Work bounce_rows_work(const SubjectCost& cost) {
    const double sides = cost.layout.sheet ? 2 : 1;
    // The light of a medium arrives at its samples instead of its receivers.
    const double rays = cost.layout.translucent && !cost.layout.at_entry
                            ? kRaysOfAveraged
                            : rays_of_receiver(cost.input.knobs);
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

// Of scatterers and their light, media left out.
LightWork bounce_light_work(const CostInput& input) {
    const double scatterers =
        std::min(static_cast<double>(count_scatterers(rays_of_receiver(input.knobs))),
                 kHitShare * count_scatterer_rays(static_cast<std::size_t>(input.receivers)));
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
        ray_work(input, sites * count_rays_of_site(rays_of_receiver(input.knobs)), 3);
    work.work.shared +=
        (kBounces - 1) * scatterers * kRaysOfScatterer * kHitShare * row_cells(3) * kBounceCell;
    return work;
}

constexpr std::array<DecisionRule, 2> kRules{
    {{"interreflection", is_any_material, decide_interreflection,
      [](const PlanEntry& entry, RowLayout& layout) {
          layout.coloured = entry.on && entry.has_bands;
      },
      nullptr, formats::TermSet::interreflection},
     {"interreflection.textures", has_textures, decide_textures,
      [](const PlanEntry& entry, RowLayout& layout) { layout.filtered = entry.on; }}}};
constexpr std::array<const KnobSpec*, 1> kKnobs{&kBounceRays};

constexpr double kCells = 4;  // in the width of the largest

// Nothing rises above its horizon. Of backs the horizon is not known.
bool is_unseen(const PlanInput& input) {
    return !input.material.sheet && !input.material.double_sided &&
           input.subject.horizon.elevation <= kLeastElevation;
}

}  // namespace

EffectDescriptor describe_interreflection(Effect id) {
    return {.id = id,
            .name = "interreflection",
            .help = "light that one surface sends to another",
            .rules = kRules,
            .knobs = kKnobs,
            .gather = {.work = bounce_rows_work},
            .exchange_rays = rays_of_receiver,
            .light_work = bounce_light_work};
}

PlanEntry decide_interreflection(const PlanInput& input) {
    PlanEntry entry;
    const Surroundings& others = input.subject.surroundings;
    const Horizon& horizon = input.subject.horizon;
    // Light enters a medium anywhere on its facets, not only at vertices.
    const double above =
        horizon.elevation * horizon.elevation + (input.material.medium ? horizon.behind_facets : 0);
    const double covered =
        input.material.sheet || input.subject.may_hold_things ? 1 : std::min(1.0, above);
    const formats::Rgb c = input.material.base_color;
    const double sent =
        formats::is_metal(input.material)
            ? static_cast<double>(std::max({c.r, c.g, c.b}) * input.subject.brightest_vertex)
            : input.subject.brightest;
    entry.bound = sent * covered * others.brightest;
    entry.has_bands = !others.is_grey;
    const bool has_rows = std::any_of(input.earlier.begin(), input.earlier.end(),
                                      [](const PlanEntry& e) { return e.on && e.rule == 0; });
    if (!is_wanted(input.knobs, "interreflection")) {
        entry.reason = "not asked for by --effects";
    } else if (!has_rows) {
        entry.reason = "nothing else is simulated";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = covered < kMostElevation * kMostElevation
                           ? "no other surface rises above its horizon"
                           : "the surfaces of the scene reflect hardly anything";
    } else {
        entry.reason = "other surfaces, or other places of this one, send light to it";
    }
    return entry;
}

bool has_textures(const PlanInput& input) {
    return input.subject.textures.texels_per_metre > 0 && is_wanted(input.knobs, "interreflection");
}

PlanEntry decide_textures(const PlanInput& input) {
    PlanEntry entry;
    const TextureFacts& textures = input.subject.textures;
    const Surroundings& all = input.subject.surroundings;
    const double cell =
        kCells *
        std::sqrt(all.area / static_cast<double>(count_scatterers(rays_of_receiver(input.knobs))));
    const bool is_unseen_here = is_unseen(input);
    const bool is_magnified = textures.texels_per_metre * cell <= 1;
    entry.bound = is_unseen_here || is_magnified ? 0 : all.brightest * textures.contrast;
    entry.on = is_worth(entry.bound, input, entry.forced);
    entry.reason = is_unseen_here ? "no other surface rises above its horizon"
                   : is_magnified ? "its texels are wider than what bounced light is averaged over"
                   : entry.on     ? "bounced light has the mean of its textures over areas"
                                  : "its textures hardly vary";
    return entry;
}

}  // namespace opaline::bake
