#include "bake/effects/volumes/volume_walks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/base/vector8.h"
#include "bake/effects/volumes/walk_parts.h"
#include "bake/trace/density/attenuation.h"
#include "formats/opal/spherical_harmonics.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {
namespace {

struct CellJob {
    const float *x, *y, *z;
    const std::uint16_t* depth[8];
    float node_weight[8];  // times the step of the codes
    float direction_x, direction_y, direction_z;
    float phase[5];
    float weight[3];
    std::size_t cells, bands;
    float* sum;
};

OPALINE_VECTOR_CLONES
void add_cells(const CellJob& job);

void add_cells(const CellJob& given) {
    const CellJob job = given;  // a copy that stores through other pointers cannot change
    using Codes = std::uint16_t __attribute__((vector_size(16)));
    for (std::size_t i = 0; i < job.cells; i += kVector) {
        const Float8 x = load8(job.x + i), y = load8(job.y + i), z = load8(job.z + i);
        const Float8 cosine = job.direction_x * x + job.direction_y * y + job.direction_z * z;
        Float8 p = all8(job.phase[4]);
        p = p * cosine + job.phase[3];
        p = p * cosine + job.phase[2];
        p = p * cosine + job.phase[1];
        p = p * cosine + job.phase[0];
        Float8 depth = all8(0.0f);
        for (std::size_t node = 0; node < 8; ++node) {
            Codes codes;
            __builtin_memcpy(&codes, job.depth[node] + i, sizeof codes);
            depth += job.node_weight[node] *
                     __builtin_convertvector(__builtin_convertvector(codes, Int8), Float8);
        }
        const Float8 light = p * exp_of_negative8(-depth);
        for (std::size_t band = 0; band < job.bands; ++band) {
            float* const to = job.sum + band * job.cells + i;
            store8(load8(to) + job.weight[band] * light, to);
        }
    }
}

// Unscattered light of all directions below kDark is none; below kJoinsAlways it joins by chance.
constexpr float kDark = 1e-6f, kJoinsAlways = 0.1f;

// Adds to `sum` the light that is scattered into a walk where it collides.
void add_light(const VolumeWalkSpace& walk, const WalkTrack& track, std::uint32_t volume,
               glm::vec3 at, glm::vec3 direction, const std::array<float, 3>& weight,
               FlightRandom& random, std::span<float> sum) {
    const DensityVolume& own = walk.space.volumes[volume];
    const NodesAround around = nodes_around(walk.lattices[volume], own.to_index * at + own.offset);
    if (!around.found) return;
    ScatteredLight light;
    float most = 0;  // light from one direction; depths are interpolated, so it is no more
    for (std::size_t i = 0; i < around.node.size(); ++i) {
        if (around.node[i] == formats::kNoNode) {
            return;  // a volume without nodes, or a point whose density has rounded to 0
        }
        const std::size_t node = walk.first[volume] + around.node[i];
        const std::size_t band = walk.depths.bands == 1 ? 0 : track.first;
        most += around.weight[i] * walk.depths.most[node * walk.depths.bands + band];
        light.depth[i] = walk.depths.codes(node, band);
        light.node_weight[i] = around.weight[i];
    }
    // Hardly any light joins deep inside, where most collisions are.
    const float joins = std::min(most / kJoinsAlways, 1.0f);
    if (most < kDark || (joins < 1 && random() >= joins)) return;
    light.direction = direction;
    light.phase = &own.phase.monomial;
    for (std::size_t band = track.first; band < track.end; ++band) {
        light.weight[band - track.first] = weight[band] / joins;
    }
    add_scattered(light, walk.cells, track.end - track.first,
                  sum.data() + track.first * walk.cells.size());
}

// Follows one walk from a receiver and adds the light that it gathers to `sum`, bands times cells.
std::uint64_t follow(const VolumeWalkSpace& walk, const WalkReceiver& receiver,
                     const WalkTrack& track, glm::vec3 direction, FlightRandom& random,
                     std::span<float> sum) {
    std::uint64_t traced = 0;
    glm::vec3 at = receiver.position;
    std::array<float, 3> weight{1, 1, 1};
    const bool is_coloured = !walk.space.is_grey;
    for (std::uint32_t n = 0; n < kMostScatterings; ++n) {
        // Tracks of one walk turn alike at their n-th collision, and fly as many mean free paths.
        if (is_coloured) random.begin_event(3 * n);
        const MetSurface met = find_surface(walk.rays, at, direction, traced);
        const Collision hit =
            sample_flight(walk.space, track.first, at, direction, met.distance, random);
        if (!hit.happens) {
            if (met.is_there() && receiver.sees_surfaces && walk.surfaces != nullptr) {
                add_seen(*walk.surfaces,
                         {at + met.distance * direction, met.normal, met.material, met.cosine},
                         weight, track.first, track.end, sum);
            }
            break;
        }
        at += hit.distance * direction;
        if (is_coloured) random.begin_event(3 * n + 1);
        const DensityVolume& own = walk.space.volumes[hit.volume];
        if (!survives(own.albedo_at(at), track.first, track.end, weight, random)) break;
        if (receiver.sees_sky) {
            add_light(walk, track, hit.volume, at, direction, weight, random, sum);
        }
        if (is_coloured) random.begin_event(3 * n + 2);
        const SampledCosine sampled = turn_walk(own.phase, direction, random);
        for (float& w : weight) {
            w *= sampled.weight;
        }
    }
    return traced;
}

void scale(std::span<float> values, float factor) {
    for (float& value : values) {
        value *= factor;
    }
}

}  // namespace

void add_scattered(const ScatteredLight& light, const LightCells& cells, std::size_t bands,
                   float* sum) {
    CellJob job{};
    job.x = cells.x.data();
    job.y = cells.y.data();
    job.z = cells.z.data();
    for (std::size_t node = 0; node < 8; ++node) {
        job.depth[node] = light.depth[node];
        job.node_weight[node] = light.node_weight[node] * DepthTable::kStep;
    }
    job.direction_x = light.direction.x;
    job.direction_y = light.direction.y;
    job.direction_z = light.direction.z;
    for (std::size_t i = 0; i < light.phase->size(); ++i) {
        job.phase[i] = (*light.phase)[i];
    }
    for (std::size_t band = 0; band < 3; ++band) {
        job.weight[band] = light.weight[band];
    }
    job.cells = cells.size();
    job.bands = bands;
    job.sum = sum;
    add_cells(job);
}

std::uint64_t gather_walks(const VolumeWalkSpace& walk, const WalkReceiver& receiver,
                           std::span<float> out, std::span<float> odd) {
    const std::size_t bands = walk.space.bands(), row = bands * walk.cells.size();
    std::ranges::fill(out, 0.0f);
    std::ranges::fill(odd, 0.0f);
    std::vector<float> sum(row);
    std::array<float, formats::kMaxHarmonics> view{1};
    const auto take = [&](std::uint32_t i, glm::vec3 direction) {
        if (receiver.terms > 1) {
            formats::eval_spherical_harmonics({direction.x, direction.y, direction.z},
                                              std::span(view).first(receiver.terms));
        }
        for (std::uint32_t k = 0; k < receiver.terms; ++k) {
            for (std::size_t j = 0; j < row; ++j) {
                out[k * row + j] += view[k] * sum[j];
            }
            for (std::size_t j = 0; i % 2 == 1 && !odd.empty() && j < row; ++j) {
                odd[k * row + j] += view[k] * sum[j];
            }
        }
    };
    const std::uint64_t traced = walk_from_node(
        walk.space, {walk.seed, RandomStage::volume_walk, receiver.node, receiver.walks, bands},
        sum,
        [&](const WalkTrack& track, glm::vec3 direction, FlightRandom& random) {
            return follow(walk, receiver, track, direction, random, sum);
        },
        take);
    const ScaledPhase& phase = walk.space.volumes[receiver.volume].phase;
    const float share = receiver.terms == 1 ? 1.0f : 4 * std::numbers::pi_v<float>;
    const std::uint32_t every_other = receiver.walks / 2;
    for (std::uint32_t k = 0; k < receiver.terms; ++k) {
        const float factor = share * scattered_harmonic(phase, k);
        scale(out.subspan(k * row, row), factor / static_cast<float>(receiver.walks));
        if (!odd.empty()) {
            scale(odd.subspan(k * row, row), factor / static_cast<float>(every_other));
        }
    }
    return traced;
}

}  // namespace opaline::bake
