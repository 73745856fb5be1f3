#include "bake/single/light_maps.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/single/spatial_order.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kLanes = RayPacket::kSize;

// Interior nodes of all receivers, those of receiver r in [first[r], first[r + 1]).
struct NodeList {
    std::vector<std::uint32_t> first{0};
    std::vector<InteriorNode> node;
    std::vector<std::uint8_t> by_rays;  // per node: maps cannot tell
    std::vector<float> scale;           // per receiver: no value of T / g_k can be larger
    float throughput = 0;               // the largest
};

// The largest Ft J at any angle.
float largest_throughput(const Interface<float>& boundary) {
    float largest = 0;
    constexpr int kSteps = 4096;
    for (int i = 1; i <= kSteps; ++i) {
        const float cosine = static_cast<float>(i) / kSteps;
        largest = std::max(largest, enter(cosine, boundary).throughput);
    }
    constexpr float kBetweenSteps = 1.02f;  // an index below 1 peaks sharply at the critical angle
    return kBetweenSteps * largest;
}

// On a crease the path runs along a side of the body, nearer than pixels can tell.
bool on_crease(const BodyPoint& point) {
    constexpr float kAlong = 0.9f;
    const glm::vec3 outward = point.position - point.inner;
    return glm::dot(outward, point.normal) < kAlong * glm::length(outward);
}

NodeList collect_nodes(const RayScene& rays, const SingleMedium& medium,
                       std::span<const BodyPoint> points, const Context& context) {
    NodeList list;
    list.throughput = largest_throughput(medium.boundary);
    using Item = std::vector<std::vector<InteriorNode>>;
    constexpr std::size_t kBlock = 256;
    for_each_block_in_order(
        points.size(), kBlock, context,
        [&](Range range) {
            Item item;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                item.push_back(place_interior_nodes(
                    medium, points[i], trace_inward_path(rays, points[i], medium.path_limit)));
            }
            return item;
        },
        [&](Range range, Item&& item) {
            for (std::size_t i = 0; i < item.size(); ++i) {
                const bool crease = on_crease(points[range.begin + i]);
                std::array<float, 3> sum{};
                for (const InteriorNode& node : item[i]) {
                    for (std::size_t c = 0; c < 3; ++c) {
                        sum[c] += node.weight[c];
                    }
                    list.node.push_back(node);
                    list.by_rays.push_back(crease || node.shells != 1 ? 1 : 0);
                }
                list.first.push_back(static_cast<std::uint32_t>(list.node.size()));
                list.scale.push_back(list.throughput * std::max({sum[0], sum[1], sum[2]}));
            }
        });
    return list;
}

// One direction of the set.
struct Direction {
    glm::vec3 w;
    float share;
};

// The directions of each texel.
std::vector<std::vector<Direction>> directions_by_texel(const DirectionSet& set) {
    const std::vector<RayPacket::Lane> shares = texel_shares(set);
    std::vector<std::vector<Direction>> texels(set.inverse_solid_angle.size());
    for (std::size_t b = 0; b < set.blocks.size(); ++b) {
        const DirectionBlock& block = set.blocks[b];
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
            texels[block.texel[lane]].push_back(
                {{block.dir_x[lane], block.dir_y[lane], block.dir_z[lane]}, shares[b][lane]});
        }
    }
    return texels;
}

// Sub-pixel position of a map, spread evenly over the directions by the plastic number's sequence.
glm::vec2 jitter_of(std::size_t index) {
    const double k = static_cast<double>(index) + 1.0;
    const double x = k * 0.7548776662466927, y = k * 0.5698402909980532;
    return {static_cast<float>(x - std::floor(x)), static_cast<float>(y - std::floor(y))};
}

// What a thread needs for a direction.
struct Workspace {
    LightView view;
    std::vector<float> value;  // [receiver][term][channel]
    struct Open {
        std::uint32_t receiver, node;
        float factor;
    };
    std::vector<Open> open;
    EntryCounts counts;
    std::uint64_t look_ups = 0, unsure = 0;
};

struct Job {
    const RayScene& rays;
    const BodyMesh& mesh;
    std::uint32_t size;
    const SingleMedium& medium;
    const NodeList& list;
    std::uint32_t terms;
    std::array<float, 4> sigma_t;  // and a fourth channel that nobody reads
    float isotropic;               // the only term where there is one
    float tolerance;               // [m]
};

// Where light enters on its way to a node.
struct Arrival {
    float distance, cosine;
    Entry<float> entry;
    glm::vec3 normal;
};

// Adds what arrives at a node, times a factor, to its receiver's terms.
void add(const Job& job, const InteriorNode& node, glm::vec3 w, const Arrival& arrival,
         float factor, float* value) {
    const float length = arrival.distance * arrival.entry.path_ratio;
    const float enters = factor * arrival.entry.throughput;
    std::array<float, 4> lit;  // a vector's worth
    for (std::size_t c = 0; c < 4; ++c) {
        lit[c] = enters * exp_of_negative(-job.sigma_t[c] * length);
    }
    for (std::size_t c = 0; c < 3; ++c) {
        lit[c] *= node.weight[c];
    }
    if (job.terms == 1) {
        for (std::size_t c = 0; c < 3; ++c) {
            value[c] += job.isotropic * lit[c];
        }
        return;
    }
    std::array<float, formats::kMaxHarmonics> g;
    eval_phase_terms(job.medium.phase, job.medium.boundary.eta, w, arrival.normal, arrival.entry,
                     arrival.cosine, std::span<float>(g).first(job.terms));
    for (std::size_t k = 0; k < job.terms; ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
            value[3 * k + c] += g[k] * lit[c];
        }
    }
}

// Evenly distributed in [0, 1), a function of the node and the direction alone.
float number_of(const InteriorNode& node, glm::vec3 w) {
    std::uint64_t hash = 0x9e3779b97f4a7c15u;
    for (const float x : {node.position.x, node.position.y, node.position.z, w.x, w.y, w.z}) {
        hash = (hash ^ std::bit_cast<std::uint32_t>(x)) * 0xbf58476d1ce4e5b9u;
        hash ^= hash >> 29;
    }
    return static_cast<float>(hash >> 40) * 0x1p-24f;
}

// How likely an unsure look-up is traced: surely where it matters.
float trace_probability(const Job& job, const InteriorNode& node, const LightAnswer& answer,
                        float scale) {
    const float ratio = answer.cosine > 0 ? answer.entry.path_ratio : 0.0f;
    float brightest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
        brightest = std::max(
            brightest, node.weight[c] * exp_of_negative(-job.sigma_t[c] * answer.nearest * ratio));
    }
    constexpr float kMatters = 0.05f;  // of the largest transport that the receiver can have
    constexpr float kLeast = 0.05f;    // bounds how much brighter a surprise can be than the truth
    return std::clamp(job.list.throughput * brightest / (kMatters * scale), kLeast, 1.0f);
}

void trace_open(const Job& job, const Direction& direction, Workspace& work) {
    for (std::size_t begin = 0; begin < work.open.size(); begin += kLanes) {
        const std::size_t count = std::min<std::size_t>(kLanes, work.open.size() - begin);
        RayPacket packet{};
        packet.dir_x.fill(direction.w.x);
        packet.dir_y.fill(direction.w.y);
        packet.dir_z.fill(direction.w.z);
        packet.mask.fill(0xffffffffu);
        LaneMask lanes{};
        std::array<std::int32_t, kLanes> shells{};
        for (std::size_t lane = 0; lane < count; ++lane) {
            const InteriorNode& node = job.list.node[work.open[begin + lane].node];
            const glm::vec3 origin = node.position - job.rays.centre();
            packet.org_x[lane] = origin.x;
            packet.org_y[lane] = origin.y;
            packet.org_z[lane] = origin.z;
            shells[lane] = node.shells;
            lanes[lane] = -1;
        }
        const PacketEntries entries =
            find_entries(job.rays, job.medium.material, lanes, packet, shells, work.counts);
        for (std::size_t lane = 0; lane < count; ++lane) {
            const Workspace::Open& open = work.open[begin + lane];
            if (entries.lit[lane] != 0) {
                add(job, job.list.node[open.node], direction.w,
                    {entries.distance[lane],
                     entries.cosine[lane],
                     enter(entries.cosine[lane], job.medium.boundary),
                     {entries.normal_x[lane], entries.normal_y[lane], entries.normal_z[lane]}},
                    open.factor, &work.value[3 * job.terms * std::size_t{open.receiver}]);
            }
        }
    }
}

void gather_node(const Job& job, const Direction& direction, std::uint32_t receiver,
                 std::uint32_t index, Workspace& work) {
    const InteriorNode& node = job.list.node[index];
    if (job.list.by_rays[index] != 0) {
        work.open.push_back({receiver, index, direction.share});
        return;
    }
    const glm::vec3 p = project(work.view.frame, node.position - job.mesh.centre);
    const LightAnswer answer = look_up(work.view, p, job.tolerance);
    ++work.look_ups;
    float factor = direction.share;
    if (!answer.sure) {
        ++work.unsure;
        const float probability = trace_probability(job, node, answer, job.list.scale[receiver]);
        if (number_of(node, direction.w) < probability) {
            // The likely answer plus what the rays find more than it: right on average.
            work.open.push_back({receiver, index, direction.share / probability});
            factor -= direction.share / probability;
        }
    }
    if (answer.lit && factor != 0) {
        add(job, node, direction.w, {answer.distance, answer.cosine, answer.entry, answer.normal},
            factor, &work.value[3 * job.terms * std::size_t{receiver}]);
    }
}

void gather_direction(const Job& job, const Direction& direction, glm::vec2 jitter,
                      Workspace& work) {
    work.open.clear();
    render_light_view(job.mesh, make_light_frame(direction.w, job.mesh.radius, job.size, jitter),
                      job.size, job.medium.boundary, work.view);
    const NodeList& list = job.list;
    for (std::uint32_t r = 0; r + 1 < list.first.size(); ++r) {
        for (std::uint32_t i = list.first[r]; i < list.first[r + 1]; ++i) {
            gather_node(job, direction, r, i, work);
        }
    }
    trace_open(job, direction, work);
}

}  // namespace

std::uint32_t light_view_size(const BodyMesh& mesh) {
    constexpr float kSmallest = 128, kLargest = 2048;
    const float wanted = mesh.mean_edge > 0 ? 8.0f * mesh.radius / mesh.mean_edge : kSmallest;
    return static_cast<std::uint32_t>(std::clamp(wanted, kSmallest, kLargest));
}

SingleRows gather_single_rows(const RayScene& rays, const BodyMesh& mesh, std::uint32_t size,
                              const DirectionSet& directions, const SingleMedium& medium,
                              std::span<const BodyPoint> given, const Context& context) {
    SingleRows result;
    std::vector<glm::vec3> positions;
    for (const BodyPoint& point : given) {
        positions.push_back(point.position);
    }
    const std::vector<std::uint32_t> order = spatial_order(positions);
    std::vector<BodyPoint> points;
    for (const std::uint32_t index : order) {
        points.push_back(given[index]);
    }
    const NodeList list = collect_nodes(rays, medium, points, context);
    const auto texels = directions_by_texel(directions);
    const std::size_t terms = medium.phase.count(), stride = 3 * terms;
    result.rows.texels = static_cast<std::uint32_t>(texels.size());
    result.rows.largest_term = largest_phase_terms(medium.phase);
    result.rows.scale.resize(points.size());
    for (std::size_t r = 0; r < points.size(); ++r) {
        result.rows.scale[order[r]] = list.scale[r];
    }
    result.rows.packed.resize(texels.size() * points.size() * terms);
    Job job{rays, mesh, size, medium, list, medium.phase.count(), {}, result.rows.largest_term[0],
            0};
    std::copy(medium.path.sigma_t.begin(), medium.path.sigma_t.end(), job.sigma_t.begin());
    constexpr float kOpticalTolerance = 0.02f;
    job.tolerance =
        kOpticalTolerance / std::max({job.sigma_t[0], job.sigma_t[1], job.sigma_t[2], 1e-30f});
    tbb::enumerable_thread_specific<Workspace> workspaces;
    tbb::task_arena arena(static_cast<int>(thread_count(context)));
    const auto gather_texel = [&](std::size_t j) {
        if (context.cancelled()) {
            return;
        }
        Workspace& work = workspaces.local();
        work.value.assign(stride * points.size(), 0.0f);
        for (std::size_t i = 0; i < texels[j].size(); ++i) {
            gather_direction(job, texels[j][i], jitter_of(j * texels[j].size() + i), work);
        }
        for (std::size_t r = 0; r < points.size(); ++r) {
            for (std::size_t k = 0; k < terms; ++k) {
                const float largest = list.scale[r] * result.rows.largest_term[k];
                const float scale = largest > 0 ? 1.0f / largest : 0.0f;
                const float lowest = k == 0 ? 0.0f : -1.0f;
                std::array<float, 3> value;
                for (std::size_t c = 0; c < 3; ++c) {
                    value[c] = std::clamp(scale * work.value[r * stride + 3 * k + c], lowest, 1.0f);
                }
                result.rows.packed[(j * points.size() + order[r]) * terms + k] =
                    pack_shared_exponent(value, k > 0);
            }
        }
    };
    arena.execute([&] { tbb::parallel_for(std::size_t{0}, texels.size(), gather_texel); });
    for (const Workspace& work : workspaces) {
        result.counts.rays += work.counts.rays;
        result.counts.missing += work.counts.missing;
        result.look_ups += work.look_ups;
        result.unsure += work.unsure;
    }
    return result;
}

}  // namespace opaline::bake
