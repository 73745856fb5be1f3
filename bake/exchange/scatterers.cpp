#include "bake/exchange/scatterers.h"

#include <algorithm>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/even_choice.h"
#include "bake/plan/surface_albedo.h"
#include "bake/receivers/other_side.h"
#include "bake/receivers/surface_samples.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/texture_pyramid.h"

namespace opaline::bake {
namespace {

// Receivers that look for scatterers, and their rays.
constexpr std::size_t kProbes = 4096;
constexpr std::uint32_t kRaysOfProbe = 16;
// Scatterers besides, where onlookers look.
constexpr std::size_t kSeenByOnlookers = 1024;

struct Seen {
    AreaTable::Triangle triangle;
    glm::vec3 barycentric{0};
    SidePoint point;
};

// Sheets look to both sides: within a lantern its inner side alone sees anything.
std::vector<Receiver> draw_probes(const formats::Scene& scene, std::span<const ReceiverSet> sets) {
    const std::size_t all = count_receivers(sets);
    const std::size_t count = std::min(all, kProbes);
    std::vector<Receiver> probes;
    probes.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto running = static_cast<std::uint32_t>((2 * i + 1) * all / (2 * count));
        const ReceiverSet& set = set_of(sets, running);
        const std::size_t own = running - set.first;
        probes.push_back(set.outside[own]);
        if (scene.materials[set.material].sheet) {
            probes.push_back(other_side(set.outside[own], set.inside[own]));
        }
    }
    return probes;
}

Scatterer make_scatterer(const LightInputs& inputs, const Seen& seen) {
    const formats::Scene& scene = inputs.bake.scene;
    const SurfacePoint point = make_surface_point(scene, seen.triangle, seen.barycentric);
    const SurfaceSample sample = make_surface_sample(scene, point, 0);
    Scatterer made;
    made.position = point.position;
    made.material = scene.primitives[point.primitive].material;
    made.behind = seen.point.side.behind;
    made.normal = seen.point.side.behind ? -point.normal : point.normal;
    made.albedo = eval_surface_albedo(scene, inputs.layouts[made.material], point);
    const glm::vec3 lift = sample.receiver.origin - point.position;
    const glm::vec3 other = point.position - glm::dot(lift, point.normal) * point.normal;
    made.outside = sample.receiver;
    made.beyond = {other, -sample.normal};
    if (seen.point.side.behind) {
        std::swap(made.outside, made.beyond);
    }
    glm::vec3 largest(0);
    const formats::Primitive& p = scene.primitives[point.primitive];
    for (std::uint32_t k = 0; k < 3; ++k) {
        largest = glm::max(largest, glm::abs(p.position[p.index[point.first_index + k]]));
    }
    const float error = intersection_error_bound(std::max({largest.x, largest.y, largest.z}));
    made.inside = {point.position, sample.normal, point.position - error * point.normal,
                   made.material};
    return made;
}

// Where rays of probes end, on sides that send light.
std::vector<Seen> look_around(const LightInputs& inputs, std::span<const Receiver> probes,
                              std::uint64_t& rays) {
    struct Part {
        std::vector<Seen> seen;
        std::uint64_t rays = 0;
    };
    std::vector<Seen> all;
    const BounceGrid grid = make_bounce_grid(kRaysOfProbe);
    constexpr std::size_t kBlock = 64;
    for_each_block_in_order(
        probes.size(), kBlock, inputs.context,
        [&](Range range) {
            Part part;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                part.rays += trace_bounces(
                    inputs.bake.rays, probes[i], grid, inputs.knobs.seed,
                    [&](const BounceHit& hit) {
                        const PacketHits& hits = hit.hits;
                        const std::size_t lane = hit.lane;
                        const SeenSide side = side_of_hit(inputs.bake.scene, hits, lane);
                        if (side.is_seen && sends_light(inputs.layouts[hits.material[lane]])) {
                            const float u = hits.u[lane], v = hits.v[lane];
                            part.seen.push_back(
                                {{hits.primitive[lane], hits.first_index[lane]},
                                 {1 - u - v, u, v},
                                 {hit.origin + hits.distance[lane] * hit.direction,
                                  {hits.material[lane], side.behind, side.normal}}});
                        }
                    });
            }
            return part;
        },
        [&](Range, Part&& part) {
            all.insert(all.end(), part.seen.begin(), part.seen.end());
            rays += part.rays;
        });
    return all;
}

void append_evenly(std::span<const Seen> all, std::size_t count, std::vector<Seen>& chosen) {
    std::vector<SidePoint> points;
    points.reserve(all.size());
    for (const Seen& seen : all) {
        points.push_back(seen.point);
    }
    for (const std::uint32_t i : choose_evenly(points, count)) {
        chosen.push_back(all[i]);
    }
}

// Over the part of the surface that each scatterer represents.
void filter_albedo(const LightInputs& inputs, std::span<const Seen> chosen,
                   std::span<Scatterer> scatterers) {
    const formats::Scene& scene = inputs.bake.scene;
    const ScenePyramids& textures = *inputs.bake.textures;
    const std::vector<float> cells = BounceTree(scatterers, inputs.layouts.size(), 0).cells();
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        Scatterer& made = scatterers[i];
        if (!has_pyramid(textures, scene.materials[made.material])) continue;
        const Seen& seen = chosen[i];
        const auto& [primitive, first_index] = seen.triangle;
        const TextureView view{
            textures, moments_of_area(uv_gradient(scene.primitives[primitive], first_index),
                                      static_cast<double>(cells[i]))};
        made.albedo =
            eval_surface_albedo(scene, inputs.layouts[made.material],
                                make_surface_point(scene, seen.triangle, seen.barycentric), &view);
    }
}

}  // namespace

float Scatterer::mirrored() const {
    const formats::Rgb& c = albedo.mirrored;
    return albedo.is_narrow ? std::clamp(std::max({c.r, c.g, c.b}), 0.0f, 1.0f) : 0;
}

std::vector<std::uint32_t> number_lobes(std::span<const Scatterer> scatterers) {
    std::vector<std::uint32_t> numbers(scatterers.size(), formats::kNone);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (scatterers[i].mirrored() > 0) numbers[i] = count++;
    }
    return numbers;
}

std::size_t count_lobes(std::span<const std::uint32_t> numbers) {
    return numbers.size() - static_cast<std::size_t>(std::ranges::count(numbers, formats::kNone));
}

SeenSide side_of(const formats::Material& material, glm::vec3 normal, float cosine) {
    SeenSide side;
    side.behind = cosine > 0;
    side.is_seen = normal != glm::vec3(0) &&
                   (!side.behind || material.sheet || (material.double_sided && !material.medium));
    side.normal = side.behind ? -normal : normal;
    side.cosine = std::abs(cosine);
    return side;
}

SeenSide side_of_hit(const formats::Scene& scene, const PacketHits& hits, std::size_t lane) {
    SeenSide side =
        side_of(scene.materials[hits.material[lane]],
                {hits.normal_x[lane], hits.normal_y[lane], hits.normal_z[lane]}, hits.cosine[lane]);
    side.is_seen = side.is_seen && hits.hit[lane] != 0;
    return side;
}

double count_scatterer_rays(std::size_t receivers) {
    return static_cast<double>(kRaysOfProbe * std::min(receivers, kProbes));
}

std::vector<Scatterer> find_scatterers(const LightInputs& inputs, std::size_t count,
                                       std::uint64_t& rays) {
    std::vector<Seen> chosen;
    append_evenly(look_around(inputs, draw_probes(inputs.bake.scene, inputs.bake.receivers), rays),
                  count, chosen);
    append_evenly(look_around(inputs, inputs.onlookers, rays), kSeenByOnlookers, chosen);
    std::vector<Scatterer> scatterers;
    scatterers.reserve(chosen.size());
    for (const Seen& seen : chosen) {
        scatterers.push_back(make_scatterer(inputs, seen));
    }
    if (inputs.bake.textures != nullptr) {
        filter_albedo(inputs, chosen, scatterers);
    }
    return scatterers;
}

std::vector<Scatterer> spread_over_material(const LightInputs& inputs, std::uint32_t material,
                                            std::size_t count) {
    const formats::Scene& scene = inputs.bake.scene;
    std::vector<std::uint32_t> own;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        if (scene.primitives[p].material == material) {
            own.push_back(p);
        }
    }
    const AreaTable table = make_area_table(scene, own);
    std::vector<Scatterer> spread;
    if (table.triangle.empty()) return spread;
    spread.reserve(count);
    for (const SurfacePoint& p :
         scatter_points(scene, table, count, false, inputs.knobs.seed, RandomStage::bounce_rays)) {
        spread.push_back(make_scatterer(
            inputs, {{p.primitive, p.first_index}, p.barycentric, {p.position, {}}}));
    }
    return spread;
}

}  // namespace opaline::bake
