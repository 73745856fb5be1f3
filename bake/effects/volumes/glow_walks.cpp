#include "bake/effects/volumes/glow_walks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/effects/volumes/walk_parts.h"
#include "bake/trace/density/grid_loops.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

// Adds to `sum`, one for each grid, the light that arrives at a point from a direction: a walk
// against the light gathers the emission along each of its flights. The track length is an unbiased
// estimate, also where emission has no density.
std::uint64_t follow_glow(const GlowWalkSpace& walk, const WalkTrack& bands, glm::vec3 at,
                          glm::vec3 direction, FlightRandom& random, std::span<glm::vec3> sum) {
    std::uint64_t traced = 0;
    std::array<float, 3> weight{};
    for (std::size_t band = bands.first; band < bands.end; ++band) {
        weight[band] = 1;
    }
    for (std::uint32_t n = 0; n < kMostScatterings; ++n) {
        const float reach = find_surface(walk.rays, at, direction, traced).distance;
        const Collision hit = sample_flight(walk.space, bands.first, at, direction, reach, random);
        const float length = hit.happens ? hit.distance : reach;
        for (std::size_t i = 0; i < walk.glow.size(); ++i) {
            sum[i] += glm::vec3(weight[0], weight[1], weight[2]) *
                      glow_along(walk.glow[i], at, direction, length);
        }
        if (!hit.happens) break;
        at += hit.distance * direction;
        const DensityVolume& own = walk.space.volumes[hit.volume];
        if (!survives(own.albedo_at(at), bands.first, bands.end, weight, random)) break;
        const SampledCosine sampled = turn_walk(own.phase, direction, random);
        for (float& w : weight) {
            w *= sampled.weight;
        }
    }
    return traced;
}

}  // namespace

std::uint64_t gather_glow(const GlowWalkSpace& walk, const GlowReceiver& receiver,
                          std::span<glm::vec3> out) {
    std::ranges::fill(out, glm::vec3(0));
    std::vector<glm::vec3> sum(walk.glow.size());
    std::array<float, formats::kMaxHarmonics> view{};
    const std::uint64_t traced = walk_from_node(
        walk.space, {walk.seed, RandomStage::volume_glow, receiver.node, receiver.walks}, sum,
        [&](const WalkTrack& bands, glm::vec3 direction, FlightRandom& random) {
            return follow_glow(walk, bands, receiver.position, direction, random, sum);
        },
        [&](std::uint32_t, glm::vec3 direction) {
            formats::eval_spherical_harmonics({direction.x, direction.y, direction.z},
                                              std::span(view).first(receiver.terms));
            for (std::size_t grid = 0; grid < sum.size(); ++grid) {
                for (std::uint32_t k = 0; k < receiver.terms; ++k) {
                    out[grid * receiver.terms + k] += view[k] * sum[grid];
                }
            }
        });
    const ScaledPhase& phase = walk.space.volumes[receiver.volume].phase;
    constexpr float kSphere = 4 * std::numbers::pi_v<float>;
    for (std::uint32_t k = 0; k < receiver.terms; ++k) {
        const float factor =
            kSphere * scattered_harmonic(phase, k) / static_cast<float>(receiver.walks);
        for (std::size_t grid = 0; grid < sum.size(); ++grid) {
            out[grid * receiver.terms + k] *= factor;
        }
    }
    return traced;
}

std::vector<GlowingGrid> make_glowing_grids(const formats::Scene& scene,
                                            const std::vector<std::uint32_t>& volumes) {
    std::vector<GlowingGrid> grids;
    for (const std::uint32_t v : volumes) {
        const formats::Volume& volume = scene.volumes[v];
        GlowingGrid own;
        own.grid = &volume.emission;
        own.volume = v;
        place_cells(volume.emission, volume.density.to_scene, own);
        for_each_point(glm::ivec3(0), own.extent, [&](glm::ivec3 cell) {
            float most = 0;
            for_each_voxel_of_cell(volume.emission, own.first_cell + cell, [&](glm::vec3 sent) {
                most = std::max({most, sent.x, sent.y, sent.z});
            });
            own.bound.push_back(most);
        });
        grids.push_back(std::move(own));
    }
    return grids;
}

glm::vec3 glow_along(const GlowingGrid& glow, glm::vec3 from, glm::vec3 direction, float length) {
    glm::vec3 all(0);
    const float voxels_per_metre = glm::length(glow.to_index * direction);
    visit_cells(glow, from, direction, length, [&](float, float begin, float end) {
        const float steps = std::max(std::ceil((end - begin) * voxels_per_metre), 1.0f);
        const float ds = (end - begin) / steps;
        glm::vec3 sum(0);
        for (float i = 0; i < steps; ++i) {
            const glm::vec3 at = from + (begin + (i + 0.5f) * ds) * direction;
            sum += glow.grid->sample(glow.to_index * at + glow.offset);
        }
        all += ds * sum;
        return true;
    });
    return all;
}

}  // namespace opaline::bake
