#include "bake/exchange/exchange_points.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>
#include <utility>

#include "bake/exchange/bounce_light.h"
#include "bake/trace/bodies_at.h"
#include "formats/opal/asset.h"

namespace opaline::bake {
namespace {

std::uint32_t nearest_scatterer(const PatchLight& points, const Receiver& at) {
    float least = std::numeric_limits<float>::max();
    std::uint32_t nearest = formats::kNone;
    for (const std::uint32_t material : points.materials) {
        const std::uint32_t node = points.tree.find(at.origin, {material, false, at.normal}, 0);
        if (node == formats::kNone) continue;
        const std::uint32_t found = points.tree.scatterer_of(node);
        const glm::vec3 d = points.scatterers[found].position - at.origin;
        if (glm::dot(d, d) < least) {
            least = glm::dot(d, d);
            nearest = found;
        }
    }
    if (nearest != formats::kNone) return nearest;
    // No scatterer faces that way.
    nearest = points.members.front();
    for (const std::uint32_t i : points.members) {
        const glm::vec3 d = points.scatterers[i].position - at.origin;
        const float square =
            glm::dot(d, d) * (glm::dot(points.scatterers[i].normal, at.normal) > 0 ? 1.0f : 4.0f);
        if (square < least) {
            least = square;
            nearest = i;
        }
    }
    return nearest;
}

// Not those in or against other bodies.
void leave_out_hidden_points(const LightInputs& inputs, std::uint32_t material,
                             std::vector<Scatterer>& spread) {
    const BodiesAt bodies(inputs.bake.scene, inputs.bake.rays.hierarchy());
    std::vector<std::uint8_t> is_own(inputs.bake.scene.materials.size());
    is_own[material] = 1;
    if (std::ranges::none_of(inputs.bake.facts.material[material].inner,
                             [](const InnerMedium& inner) { return inner.depth == 0; }) &&
        !bodies.has_faces_on_faces(inputs.bake.scene, is_own)) {
        return;
    }
    std::erase_if(spread, [&](const Scatterer& s) {
        return bodies.material_at(s.position + 2 * bodies.touch() * s.normal) != formats::kNone;
    });
}

// Light enters a medium where no receiver looks, too: points all over those that are seen.
void add_spread(const LightInputs& inputs, std::vector<Scatterer>& scatterers) {
    constexpr std::size_t kEvenPoints = 256;
    std::vector<std::uint8_t> is_seen(inputs.layouts.size());
    for (const Scatterer& s : scatterers) {
        is_seen[s.material] = inputs.layouts[s.material].translucent ? 1 : 0;
    }
    for (std::uint32_t m = 0; m < is_seen.size(); ++m) {
        if (is_seen[m] == 0) continue;
        std::vector<Scatterer> spread = spread_over_material(inputs, m, kEvenPoints);
        leave_out_hidden_points(inputs, m, spread);
        scatterers.insert(scatterers.end(), spread.begin(), spread.end());
    }
}

// Surfaces inside media, which no ray of a receiver need come to: points all over them.
void add_points_inside(const LightInputs& inputs, std::vector<Scatterer>& scatterers) {
    constexpr std::size_t kPoints = 256;
    const formats::Scene& scene = inputs.bake.scene;
    const BodiesAt bodies(scene, inputs.bake.rays.hierarchy());
    if (bodies.order().empty()) return;
    for (std::uint32_t m = 0; m < inputs.layouts.size(); ++m) {
        if (scene.materials[m].medium || !sends_light(inputs.layouts[m])) continue;
        std::vector<Scatterer> spread = spread_over_material(inputs, m, kPoints);
        std::erase_if(spread, [&](const Scatterer& s) {
            return bodies.material_at(s.position + 2 * bodies.touch() * s.normal) == formats::kNone;
        });
        scatterers.insert(scatterers.end(), spread.begin(), spread.end());
    }
}

// The first material of those whose media meet or lie in each other, of each material.
std::vector<std::uint32_t> group_media(const SceneFacts& facts) {
    std::vector<std::uint32_t> first(facts.material.size());
    std::iota(first.begin(), first.end(), 0u);
    bool changes = true;
    while (changes) {
        changes = false;
        for (std::uint32_t m = 0; m < first.size(); ++m) {
            for (const InnerMedium& inner : facts.material[m].inner) {
                std::uint32_t &a = first[m], &b = first[inner.material];
                changes = changes || a != b;
                a = b = std::min(a, b);
            }
        }
    }
    return first;
}

}  // namespace

void add_patch(const PatchLight& light, const Receiver& at, std::span<float> row) {
    row[light.patch[nearest_scatterer(light, at)]] += 1;
}

ExchangePoints place_exchange(const LightInputs& inputs, std::uint64_t& rays) {
    ExchangePoints points{find_scatterers(inputs, count_scatterers(inputs.rays_of_receiver), rays)};
    add_points_inside(inputs, points.scatterers);
    if (points.scatterers.empty()) return points;
    add_spread(inputs, points.scatterers);
    const std::vector<std::uint32_t> first = group_media(inputs.bake.facts);
    std::vector<std::vector<std::uint32_t>> members(inputs.layouts.size());
    for (std::uint32_t i = 0; i < points.scatterers.size(); ++i) {
        const std::uint32_t material = points.scatterers[i].material;
        if (inputs.layouts[material].translucent) members[first[material]].push_back(i);
    }
    for (auto& own : members) {
        std::ranges::stable_sort(own, {},
                                 [&](std::uint32_t i) { return points.scatterers[i].material; });
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
