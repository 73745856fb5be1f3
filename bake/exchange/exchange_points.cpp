#include "bake/exchange/exchange_points.h"

#include <utility>

#include "bake/exchange/bounce_light.h"

namespace opaline::bake {
namespace {

// Light enters a medium where no receiver looks, too: points all over those that are seen.
void add_spread(const LightInputs& inputs, std::vector<Scatterer>& scatterers) {
    constexpr std::size_t kEvenPoints = 256;
    std::vector<std::uint8_t> is_seen(inputs.layouts.size());
    for (const Scatterer& s : scatterers) {
        is_seen[s.material] = inputs.layouts[s.material].translucent ? 1 : 0;
    }
    for (std::uint32_t m = 0; m < is_seen.size(); ++m) {
        if (is_seen[m] == 0) continue;
        const std::vector<Scatterer> spread = spread_over_material(inputs, m, kEvenPoints);
        scatterers.insert(scatterers.end(), spread.begin(), spread.end());
    }
}

}  // namespace

ExchangePoints place_exchange(const LightInputs& inputs, std::uint64_t& rays) {
    ExchangePoints points{find_scatterers(inputs, count_scatterers(inputs.rays_of_receiver), rays)};
    if (points.scatterers.empty()) return points;
    add_spread(inputs, points.scatterers);
    std::vector<std::vector<std::uint32_t>> members(inputs.layouts.size());
    for (std::uint32_t i = 0; i < points.scatterers.size(); ++i) {
        const std::uint32_t material = points.scatterers[i].material;
        if (inputs.layouts[material].translucent) members[material].push_back(i);
    }
    std::erase_if(members, [](const auto& own) { return own.empty(); });
    if (members.empty()) return points;
    points.tree.emplace(points.scatterers, inputs.layouts.size(), 0);
    points.patch.resize(points.scatterers.size());
    const std::vector<float> cells = points.tree->cells();
    for (std::vector<std::uint32_t>& own : members) {
        points.media.push_back(cut_medium(points.scatterers, cells, std::move(own)));
        const MediumAnswer& medium = points.media.back();
        for (std::size_t m = 0; m < medium.members.size(); ++m) {
            points.patch[medium.members[m]] = medium.patch[m];
        }
    }
    return points;
}

}  // namespace opaline::bake
