#include "bake/exchange/scatterers.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/bounce_rays.h"
#include "bake/exchange/bounce_tree.h"
#include "bake/plan/surface_albedo.h"
#include "bake/receivers/other_side.h"
#include "bake/receivers/surface_samples.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/texture_pyramid.h"

namespace opaline::bake {
namespace {

class EvenChoice {
  public:
    explicit EvenChoice(std::span<const SidePoint> points) : points_(points) {}

    // Appends `count` of the members, in [1, their number], to `chosen`.
    void choose(std::span<std::uint32_t> members, std::size_t count) {
        if (count == members.size()) {
            chosen.insert(chosen.end(), members.begin(), members.end());
            return;
        }
        glm::vec3 low(place(members[0])), high(low), sum(0);
        for (const std::uint32_t i : members) {
            low = glm::min(low, place(i));
            high = glm::max(high, place(i));
            sum += place(i);
        }
        if (count == 1) {
            const glm::vec3 middle = sum / static_cast<float>(members.size());
            chosen.push_back(*std::ranges::min_element(
                members, {}, [&](std::uint32_t i) { return glm::distance(place(i), middle); }));
            return;
        }
        const glm::vec3 extent = high - low;
        const glm::length_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                                   : extent.y >= extent.z                       ? 1
                                                                                : 2;
        const std::size_t left = count / 2, split = members.size() * left / count;
        std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(split),
                         members.end(), [&](std::uint32_t a, std::uint32_t b) {
                             const float x = place(a)[axis], y = place(b)[axis];
                             return x < y || (x == y && a < b);
                         });
        choose(members.first(split), left);
        choose(members.subspan(split), count - left);
    }

    std::vector<std::uint32_t> chosen;

  private:
    glm::vec3 place(std::uint32_t i) const { return points_[i].position; }

    std::span<const SidePoint> points_;
};

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
                                 {hit.origin + hits.distance[lane] * hit.direction -
                                      hits.offset[lane],
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

std::vector<std::uint32_t> choose_evenly(std::span<const SidePoint> points, std::size_t count) {
    const std::size_t kept = std::min(count, points.size());
    std::vector<std::size_t> side(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SurfaceSide& own = points[i].side;
        side[i] = first_side_axis(own.material, own.behind) + nearest_side_axis(own.normal);
    }
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return side[i]; });
    EvenChoice choice(points);
    choice.chosen.reserve(kept);
    for (std::size_t begin = 0; begin < order.size();) {
        std::size_t end = begin;
        while (end < order.size() && side[order[end]] == side[order[begin]]) {
            ++end;
        }
        // Shares of a whole number that add up to it.
        const std::size_t share = end * kept / order.size() - begin * kept / order.size();
        if (share > 0) {
            choice.choose(std::span(order).subspan(begin, end - begin), share);
        }
        begin = end;
    }
    return choice.chosen;
}

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
