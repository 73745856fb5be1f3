#include "bake/check/surface_probes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/receivers/surface_points.h"
#include "bake/receivers/surface_samples.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/copies.h"
#include "bake/trace/hidden_receivers.h"

namespace opaline::bake {
namespace {

// Index of each primitive's first vertex in the asset.
std::vector<std::uint32_t> first_vertices(const formats::Scene& scene) {
    std::vector<std::uint32_t> first;
    std::uint32_t sum = 0;
    for (const formats::Primitive& p : scene.primitives) {
        first.push_back(sum);
        sum += static_cast<std::uint32_t>(p.position.size());
    }
    return first;
}

CheckPoint make_probe(const formats::Scene& scene, const SurfacePoint& at,
                      std::uint32_t first_vertex) {
    const formats::Primitive& primitive = scene.primitives[at.primitive];
    const SurfaceSample sample = make_surface_sample(scene, at, 0);
    CheckPoint probe;
    probe.primitive = at.primitive;
    probe.material = primitive.material;
    float magnitude = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t v = primitive.index[at.first_index + k];
        probe.vertex[k] = first_vertex + v;
        probe.weight[k] = at.barycentric[static_cast<glm::length_t>(k)];
        const glm::vec3 a = glm::abs(primitive.position[v]);
        magnitude = std::max({magnitude, a.x, a.y, a.z});
    }
    probe.receiver = sample.receiver;
    // Just behind the facet, where the smooth surface may lie far above it.
    const glm::vec3 inner = at.position - intersection_error_bound(magnitude) * at.normal;
    probe.body = {at.position, sample.normal, inner, primitive.material};
    return probe;
}

}  // namespace

std::vector<CheckPoint> draw_surface_probes(const formats::Scene& scene, const RayScene& rays,
                                            const std::vector<std::uint32_t>& primitives,
                                            const ProbeOptions& options, const Context& context) {
    const AreaTable table = make_area_table(scene, primitives);
    if (!(table.total() > 0)) {
        return {};
    }
    const std::vector<std::uint32_t> first_vertex = first_vertices(scene);
    const std::vector<SurfacePoint> places = scatter_points(
        scene, table, options.count, false, options.seed, RandomStage::surface_probes);
    std::vector<CheckPoint> probes;
    constexpr std::size_t kBlock = 64;
    for_each_block_in_order(
        places.size(), kBlock, context,
        [&](Range range) {
            std::vector<CheckPoint> block;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                CheckPoint probe = make_probe(scene, places[i], first_vertex[places[i].primitive]);
                probe.key = options.first_key + static_cast<std::uint32_t>(i);
                if (!is_hidden(rays, probe.receiver)) {
                    block.push_back(probe);
                }
            }
            return block;
        },
        [&](Range, const std::vector<CheckPoint>& block) {
            probes.insert(probes.end(), block.begin(), block.end());
        });
    return probes;
}

std::vector<CheckPoint> make_check_points(std::span<const ReceiverSet> sets,
                                          const formats::SlotsView& slots,
                                          std::span<const std::uint32_t> drawn) {
    std::vector<CheckPoint> checked;
    checked.reserve(drawn.size());
    for (const std::uint32_t v : drawn) {
        const ReceiverSet& set = set_of(sets, v);
        CheckPoint point;
        point.primitive = set.primitive;
        point.material = set.material;
        point.vertex.fill(slots.empty() ? v : slots.vertex[v]);
        point.receiver = set.outside[v - set.first];
        point.body = set.inside[v - set.first];
        point.key = v;
        checked.push_back(point);
    }
    return checked;
}

void turn_thin_walled(const formats::Scene& scene, std::span<CheckPoint> points) {
    for (CheckPoint& point : points) {
        point.behind =
            scene.materials[point.material].sheet.has_value() && std::popcount(point.key) % 2 == 1;
    }
}

void move_to_copies(const formats::Scene& scene, std::uint64_t seed, std::span<CheckPoint> points) {
    constexpr std::uint32_t kOfCopies = 0xfffffffeu;  // no sample of the truth has that number
    const std::vector<std::vector<std::uint32_t>> copies = copies_of_primitives(scene);
    for (CheckPoint& point : points) {
        const std::vector<std::uint32_t>& own = copies[point.primitive];
        const float u = random_uniform(seed, RandomStage::check_points, point.key, kOfCopies)[0];
        const auto chosen = static_cast<std::size_t>(u * static_cast<float>(own.size() + 1));
        if (chosen >= own.size()) continue;
        const glm::vec3 offset = scene.primitives[own[chosen]].copy.offset;
        point.receiver = moved(point.receiver, offset);
        point.body.position += offset;
        point.body.inner += offset;
    }
}

void turn_views(std::span<const glm::vec3> normals, std::uint64_t seed,
                std::span<CheckPoint> points) {
    constexpr std::uint32_t kOfViews = 0xffffffffu;  // no sample of the truth has that number
    constexpr double kLeast = 0.18;                  // of the squared cosine
    constexpr float kSeen = 0.2f;
    for (CheckPoint& point : points) {
        const auto u = random_uniform(seed, RandomStage::check_points, point.key, kOfViews);
        if (point.body.normal == glm::vec3(0) || u[0] < 0.25f) continue;
        const double cosine = std::sqrt(kLeast + (1 - kLeast) * static_cast<double>(u[1]));
        const double sine = std::sqrt(1 - cosine * cosine);
        const double azimuth = 2 * std::numbers::pi * static_cast<double>(u[2]);
        const glm::vec3 view =
            make_frame(point.body.normal)
                .to_world(glm::vec3(
                    glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine)));
        const bool is_seen = std::ranges::all_of(
            point.vertex, [&](std::uint32_t v) { return glm::dot(normals[v], view) > kSeen; });
        point.to_eye = is_seen ? view : glm::vec3(0);
    }
}

}  // namespace opaline::bake
