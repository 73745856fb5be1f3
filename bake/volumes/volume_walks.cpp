#include "bake/volumes/volume_walks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/volumes/add_scattered.h"
#include "formats/opal/spherical_harmonics.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {
namespace {

constexpr float kRoulette = 0.25f;  // weight below which a walk may end

// Uniform numbers of one walk, in order.
class WalkRandom {
  public:
    WalkRandom(std::uint64_t seed, std::uint64_t walk) : seed_(seed), walk_(walk) {}

    float operator()() {
        if (used_ == number_.size()) {
            number_ = random_uniform(seed_, RandomStage::volume_walk, walk_, draw_++);
            used_ = 0;
        }
        return number_[used_++];
    }

  private:
    std::uint64_t seed_, walk_;
    std::uint32_t draw_ = 0;
    std::size_t used_ = 4;
    std::array<float, 4> number_{};
};

// Direction i of `count` that cover the sphere evenly, turned by two random numbers.
glm::vec3 even_direction(std::uint32_t i, std::uint32_t count, float u, float v) {
    constexpr double kGolden = 0.61803398874989485;
    const double z =
        1 - 2 * (static_cast<double>(i) + static_cast<double>(u)) / static_cast<double>(count);
    const double turn = static_cast<double>(i) * kGolden + static_cast<double>(v);
    const double angle = 2 * std::numbers::pi * (turn - std::floor(turn));
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return glm::vec3(glm::dvec3(r * std::cos(angle), r * std::sin(angle), z));
}

// Distance [m] to the first surface, infinite without one.
float distance_to_surface(const RayScene& rays, glm::vec3 from, glm::vec3 direction,
                          std::uint64_t& traced) {
    if (rays.is_empty()) {
        return std::numeric_limits<float>::infinity();
    }
    RayPacket packet = rays_from(from);
    LaneMask lanes{};
    lanes[0] = -1;
    packet.dir_x[0] = direction.x;
    packet.dir_y[0] = direction.y;
    packet.dir_z[0] = direction.z;
    packet.tfar[0] = std::numeric_limits<float>::infinity();
    const PacketHits hits = rays.closest(lanes, packet);
    ++traced;
    return hits.hit[0] != 0 ? hits.distance[0] : std::numeric_limits<float>::infinity();
}

// One walk that follows the extinction of `band`, for the bands [first, end).
struct Track {
    std::size_t band = 0, first = 0, end = 1;
};

// Adds to `sum` the light that is scattered into a walk where it collides.
void add_light(const VolumeWalkSpace& walk, const Track& track, std::uint32_t volume, glm::vec3 at,
               glm::vec3 direction, const std::array<float, 3>& weight, std::span<float> sum) {
    const DensityVolume& own = walk.space.volumes[volume];
    const NodesAround around = nodes_around(walk.lattices[volume], own.to_index * at + own.offset);
    if (!around.found) {
        return;
    }
    ScatteredLight light;
    bool is_dark = true;
    for (std::size_t i = 0; i < around.node.size(); ++i) {
        if (around.node[i] == formats::kNoNode) {
            return;  // a volume without nodes, or a point whose density has rounded to 0
        }
        const std::size_t node = walk.first[volume] + around.node[i];
        is_dark = is_dark && walk.depths.is_dark[node];
        light.depth[i] = walk.depths.codes(node, walk.depths.bands == 1 ? 0 : track.band);
        light.node_weight[i] = around.weight[i];
    }
    if (is_dark) {
        return;
    }
    light.direction = direction;
    light.phase = &own.phase.monomial;
    for (std::size_t band = track.first; band < track.end; ++band) {
        light.weight[band - track.first] = weight[band];
    }
    add_scattered(light, walk.cells, track.end - track.first,
                  sum.data() + track.first * walk.cells.size());
}

// Follows one walk from a point; what it meets is added to `sum`, bands times cells.
std::uint64_t follow(const VolumeWalkSpace& walk, const Track& track, glm::vec3 at,
                     glm::vec3 direction, WalkRandom& random, std::span<float> sum) {
    std::uint64_t traced = 0;
    std::array<float, 3> weight{1, 1, 1};
    for (std::uint32_t n = 0; n < kMostScatterings; ++n) {
        const float reach = distance_to_surface(walk.rays, at, direction, traced);
        const Collision hit = sample_flight(walk.space, track.band, at, direction, reach, random);
        if (!hit.happens) {
            break;
        }
        at += hit.distance * direction;
        const DensityVolume& own = walk.space.volumes[hit.volume];
        float most = 0;
        for (std::size_t band = track.first; band < track.end; ++band) {
            weight[band] *= own.albedo[band];
            most = std::max(most, std::abs(weight[band]));
        }
        if (most < kRoulette) {
            if (random() * kRoulette >= most) {
                break;
            }
            for (float& w : weight) {
                w *= kRoulette / most;
            }
        }
        add_light(walk, track, hit.volume, at, direction, weight, sum);
        const SampledCosine sampled = sample_scaled(own.phase, random());
        const float angle = 2 * std::numbers::pi_v<float> * random();
        const float sine = std::sqrt(std::max(0.0f, 1 - sampled.cosine * sampled.cosine));
        direction = make_frame(direction).to_world(
            {sine * std::cos(angle), sine * std::sin(angle), sampled.cosine});
        direction = glm::normalize(direction);
        for (float& w : weight) {
            w *= sampled.weight;
        }
    }
    return traced;
}

}  // namespace

std::uint64_t gather_walks(const VolumeWalkSpace& walk, const WalkReceiver& receiver,
                           std::span<float> out) {
    const std::size_t bands = walk.space.bands(), row = bands * walk.cells.size();
    std::ranges::fill(out, 0.0f);
    std::vector<Track> tracks{{0, 0, bands}};
    if (!walk.space.is_grey) {
        tracks = {{0, 0, 1}, {1, 1, 2}, {2, 2, 3}};
    }
    std::vector<float> sum(row);
    std::array<float, formats::kMaxHarmonics> view{1};
    std::uint64_t traced = 0;
    WalkRandom shift(walk.seed, receiver.node);
    const float u = shift(), v = shift();
    for (std::uint32_t i = 0; i < receiver.walks; ++i) {
        const glm::vec3 direction = even_direction(i, receiver.walks, u, v);
        std::ranges::fill(sum, 0.0f);
        for (const Track& track : tracks) {
            // Bands of one walk share its numbers, so that its noise has no colour.
            WalkRandom random(walk.seed,
                              (std::uint64_t{i} + 1) << 40 | std::uint64_t{receiver.node});
            traced += follow(walk, track, receiver.position, direction, random, sum);
        }
        if (receiver.terms > 1) {
            formats::eval_spherical_harmonics({direction.x, direction.y, direction.z},
                                              std::span(view).first(receiver.terms));
        }
        for (std::uint32_t k = 0; k < receiver.terms; ++k) {
            for (std::size_t j = 0; j < row; ++j) {
                out[k * row + j] += view[k] * sum[j];
            }
        }
    }
    // Of J: coefficient k is (-1)^l lambda'_l times that of the incident radiance.
    const ScaledPhase& phase = walk.space.volumes[receiver.volume].phase;
    const float share = receiver.terms == 1 ? 1.0f : 4 * std::numbers::pi_v<float>;
    for (std::uint32_t k = 0, degree = 0; k < receiver.terms; ++k) {
        degree += k >= (degree + 1) * (degree + 1) ? 1 : 0;
        const float factor = (degree % 2 == 0 ? share : -share) *
                             static_cast<float>(phase.lambda[degree]) /
                             static_cast<float>(receiver.walks);
        for (std::size_t j = 0; j < row; ++j) {
            out[k * row + j] *= factor;
        }
    }
    return traced;
}

}  // namespace opaline::bake
