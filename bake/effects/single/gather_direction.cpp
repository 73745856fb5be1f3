#include "bake/effects/single/gather_direction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <span>

#include "bake/effects/single/packed_rows.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

// The point at which light enters on its way to a node.
struct Arrival {
    float distance, cosine;
    Entry<float> entry;
    glm::vec3 normal;
};

Arrival arrival_of(const GatherJob& job, const LightView& view, std::uint32_t triangle,
                   float distance) {
    const LightFrame& frame = view.frame;
    const glm::vec2 slope = frame.pixels_per_metre * view.slope[triangle];
    const float cosine = 1.0f / std::sqrt(1.0f + glm::dot(slope, slope));
    return {distance, cosine, enter(cosine, job.medium.boundary),
            cosine * (frame.w - slope.x * frame.u - slope.y * frame.v)};
}

// Adds light that arrives to the terms of a receiver. Templates over the number of bands are
// compiled for 1 and 3.
template <std::size_t kBands>
void add(const GatherJob& job, glm::vec3 w, const Arrival& arrival, const BandValues<kBands>& light,
         float* value) {
    if (job.terms == 1) {
        for (std::size_t c = 0; c < kBands; ++c) {
            value[c] += job.isotropic * light[c];
        }
        return;
    }
    std::array<float, formats::kMaxHarmonics> g;
    eval_phase_terms(job.medium.phase, job.medium.boundary.eta, w, arrival.normal, arrival.entry,
                     arrival.cosine, std::span<float>(g).first(job.terms));
    for (std::size_t k = 0; k < job.terms; ++k) {
        for (std::size_t c = 0; c < kBands; ++c) {
            value[kBands * k + c] += g[k] * light[c];
        }
    }
}

// The light that reaches a node, per band, times a factor.
template <std::size_t kBands>
BandValues<kBands> attenuate(const GatherJob& job, const InteriorNode& node, const Arrival& arrival,
                             float factor) {
    const float length = arrival.distance * arrival.entry.path_ratio;
    BandValues<kBands> light;
    for (std::size_t c = 0; c < kBands; ++c) {
        light[c] = factor * arrival.entry.throughput * node.weight[c] *
                   exp_of_negative(-job.column.sigma_t[c] * length);
    }
    return light;
}

// A hash of the node and the direction, uniform in [0, 1). It ignores exponents, so that scaling
// the scene by a power of two does not change it.
float number_of(const InteriorNode& node, glm::vec3 w) {
    std::uint64_t hash = 0x9e3779b97f4a7c15u;
    for (const float x : {node.position.x, node.position.y, node.position.z, w.x, w.y, w.z}) {
        hash = (hash ^ (std::bit_cast<std::uint32_t>(x) & 0x807fffffu)) * 0xbf58476d1ce4e5b9u;
        hash ^= hash >> 29;
    }
    return static_cast<float>(hash >> 40) * 0x1p-24f;
}

// Probability that an unsure look-up is traced: 1 where its light matters. Where the node may be
// dark or lit, the probability is never 0, so that errors have mean zero; in a thin sheet this can
// concern all nodes. Where only the distance is unsure and the expected error is below the
// tolerance, no ray is traced.
template <std::size_t kBands>
float trace_probability(const GatherJob& job, const InteriorNode& node, const LightAnswer& answer,
                        float path_ratio, float scale) {
    constexpr float kSlack = 4.0f;  // the true error may exceed the difference between the planes
    float error = 0;
    for (std::size_t c = 0; c < kBands; ++c) {
        const float sigma = job.column.sigma_t[c] * path_ratio;
        const float change = std::min(1.0f, kSlack * sigma * answer.uncertainty);
        error = std::max(error, change * node.weight[c] * exp_of_negative(-sigma * answer.nearest));
    }
    constexpr float kMatters = 0.07f;  // share of the receiver's largest possible light
    constexpr float kLeast = 0.05f;    // bounds the weight 1 / probability of a traced look-up
    const float part = job.column.throughput * error / (kMatters * scale);
    if (answer.uncertainty < std::numeric_limits<float>::infinity()) {
        return part < 1.0f ? 0.0f : 1.0f;
    }
    return std::clamp(part, kLeast, 1.0f);
}

template <std::size_t kBands>
void trace_open(const GatherJob& job, const GatherDirection& direction, GatherWorkspace& work) {
    for (std::size_t begin = 0; begin < work.open.size(); begin += RayPacket::kSize) {
        const std::size_t count = std::min<std::size_t>(RayPacket::kSize, work.open.size() - begin);
        RayPacket packet{};
        packet.dir_x.fill(direction.w.x);
        packet.dir_y.fill(direction.w.y);
        packet.dir_z.fill(direction.w.z);
        packet.mask.fill(0xffffffffu);
        LaneMask lanes{};
        std::array<std::int32_t, RayPacket::kSize> shells{};
        for (std::size_t lane = 0; lane < count; ++lane) {
            const InteriorNode& node = *work.open[begin + lane].node;
            const glm::vec3 origin = node.position;
            packet.org_x[lane] = origin.x;
            packet.org_y[lane] = origin.y;
            packet.org_z[lane] = origin.z;
            shells[lane] = node.shells;
            lanes[lane] = -1;
        }
        const PacketEntries entries =
            find_entries(job.rays, job.medium.material, lanes, packet, shells, work.counts);
        for (std::size_t lane = 0; lane < count; ++lane) {
            if (entries.lit[lane] == 0) continue;
            const GatherWorkspace::Open& open = work.open[begin + lane];
            const Arrival arrival{
                entries.distance[lane],
                entries.cosine[lane],
                enter(entries.cosine[lane], job.medium.boundary),
                {entries.normal_x[lane], entries.normal_y[lane], entries.normal_z[lane]}};
            add<kBands>(job, direction.w, arrival,
                        attenuate<kBands>(job, *open.node, arrival, open.factor),
                        &work.value[kBands * job.terms * std::size_t{open.receiver}]);
        }
    }
}

// Looks up a node at a silhouette, a crease or between thin layers.
template <std::size_t kBands>
void gather_unclear(const GatherJob& job, const GatherDirection& direction, std::uint32_t receiver,
                    const InteriorNode& node, float margin, GatherWorkspace& work) {
    const glm::vec3 p = project(work.view.frame, node.position - job.mesh.centre);
    const LightAnswer answer = look_up(job.mesh, work.view, p, job.column.tolerance, margin);
    Arrival arrival{};
    if (answer.triangle != formats::kNone) {
        arrival = arrival_of(job, work.view, answer.triangle, answer.distance);
    }
    float factor = direction.share;
    if (!answer.sure) {
        ++work.unsure;
        const float probability = trace_probability<kBands>(
            job, node, answer, arrival.entry.path_ratio, job.list.scale[receiver]);
        if (number_of(node, direction.w) < probability) {
            // The expected answer plus the weighted difference that the rays find: unbiased.
            work.open.push_back({&node, receiver, direction.share / probability});
            factor -= direction.share / probability;
        }
    }
    if (answer.lit && factor != 0) {
        add<kBands>(job, direction.w, arrival, attenuate<kBands>(job, node, arrival, factor),
                    &work.value[kBands * job.terms * std::size_t{receiver}]);
    }
}

template <std::size_t kBands>
void gather_block(const GatherJob& job, const GatherDirection& direction,
                  const NodeList::Block& block, GatherWorkspace& work) {
    const NodeList& list = job.list;
    const std::uint32_t begin = list.first[block.receiver];
    const std::uint32_t end = list.first[block.receiver + block.receivers];
    const ColumnAnswers& answers = work.answers;
    look_up_columns(work.view, list.points, begin, end - begin, job.column, work.answers);
    work.look_ups += end - begin;
    for (std::uint32_t r = block.receiver; r < block.receiver + block.receivers; ++r) {
        float* value = &work.value[kBands * job.terms * std::size_t{r}];
        BandValues<kBands> sum{};
        for (std::uint32_t i = list.first[r]; i < list.first[r + 1]; ++i) {
            const std::uint32_t k = i - begin;
            const std::int32_t state = answers.state[k];
            if (state == ColumnAnswers::unclear) {
                // Prefetch, because the data of unclear nodes are far apart in memory.
                __builtin_prefetch(&list.node[i]);
                __builtin_prefetch(&job.mesh.triangle[answers.triangle[k]]);
                work.unclear.push_back({i, r, answers.triangle[k]});
            } else if (job.terms > 1 && state == ColumnAnswers::lit) {
                BandValues<kBands> light;
                for (std::size_t c = 0; c < kBands; ++c) {
                    light[c] = direction.share * answers.light[c][k];
                }
                add<kBands>(job, direction.w,
                            arrival_of(job, work.view, answers.triangle[k], answers.distance[k]),
                            light, value);
            }
            for (std::size_t c = 0; c < kBands; ++c) {
                sum[c] += answers.light[c][k];
            }
        }
        if (job.terms == 1) {
            for (std::size_t c = 0; c < kBands; ++c) {
                value[c] += job.isotropic * direction.share * sum[c];
            }
        }
    }
    for (const GatherWorkspace::Unclear& unclear : work.unclear) {
        const glm::uvec3& t = job.mesh.triangle[unclear.triangle];
        for (glm::length_t corner = 0; corner < 3; ++corner) {
            __builtin_prefetch(&work.view.projected[t[corner]]);
        }
    }
    for (const GatherWorkspace::Unclear& unclear : work.unclear) {
        gather_unclear<kBands>(job, direction, unclear.receiver, list.node[unclear.node], 0.0f,
                               work);
    }
    work.unclear.clear();
}

template <std::size_t kBands>
void gather_view(const GatherJob& job, const GatherDirection& direction, GatherWorkspace& work) {
    const NodeList& list = job.list;
    for (const NodeList::Block& block : list.blocks) {
        gather_block<kBands>(job, direction, block, work);
    }
    constexpr float kNear = 2.0f;  // [pixels]
    const float margin = kNear / work.view.frame.pixels_per_metre;
    for (const NodeList::Hard& hard : list.hard) {
        if (hard.crease) {
            gather_unclear<kBands>(job, direction, hard.receiver, hard.node, margin, work);
            ++work.look_ups;
        } else {
            work.open.push_back({&hard.node, hard.receiver, direction.share});
        }
    }
    trace_open<kBands>(job, direction, work);
}

}  // namespace

GatherJob make_gather_job(const RayScene& rays, const BodyMesh& mesh, std::uint32_t size,
                          const SingleMedium& medium, const NodeList& list) {
    GatherJob job{rays, mesh, size, medium, list, medium.phase.count(), 0, {}};
    job.isotropic = largest_phase_terms(medium.phase)[0];
    ColumnMedium& column = job.column;
    column.channels = medium.bands;
    std::copy(medium.path.sigma_t.begin(), medium.path.sigma_t.end(), column.sigma_t.begin());
    constexpr float kOpticalTolerance = 0.02f;
    column.tolerance = kOpticalTolerance /
                       std::max({column.sigma_t[0], column.sigma_t[1], column.sigma_t[2], 1e-30f});
    column.throughput = list.throughput;
    column.boundary = medium.boundary;
    return job;
}

void gather_direction(const GatherJob& job, const GatherDirection& direction, glm::vec2 jitter,
                      GatherWorkspace& work) {
    work.open.clear();
    render_light_view(job.mesh, make_light_frame(direction.w, job.mesh.radius, job.size, jitter),
                      job.size, work.view);
    work.answers.resize(job.list.largest_block, job.column.channels);
    job.medium.bands == 1 ? gather_view<1>(job, direction, work)
                          : gather_view<3>(job, direction, work);
}

}  // namespace opaline::bake
