#include "bake/check/volumes/volume_probes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/check/volumes/see_through.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

constexpr float kForever = std::numeric_limits<float>::infinity();
using Grid = formats::SparseGrid<float>;

// Four numbers of one probe and one purpose.
std::array<float, 4> draw(std::uint64_t seed, std::uint32_t probe, std::uint32_t purpose) {
    return random_uniform(seed, RandomStage::volume_rays, probe, purpose);
}

// All bricks of all volumes with their share of the extinction.
struct Bricks {
    struct Brick {
        std::size_t volume = 0;
        glm::ivec3 place{0};
        double before_and_own = 0;  // sum of extinction times volume up to this one
    };
    std::vector<Brick> list;
};

Bricks weigh_bricks(std::span<const formats::Volume> volumes) {
    Bricks bricks;
    double sum = 0;
    for (std::size_t v = 0; v < volumes.size(); ++v) {
        const Grid& grid = volumes[v].density;
        const formats::Rgb s = volumes[v].sigma_t;
        const double weight = static_cast<double>(s.r + s.g + s.b) *
                              std::abs(glm::determinant(glm::dmat3(grid.to_scene)));
        glm::ivec3 b;
        for (b.z = 0; b.z < grid.extent.z; ++b.z) {
            for (b.y = 0; b.y < grid.extent.y; ++b.y) {
                for (b.x = 0; b.x < grid.extent.x; ++b.x) {
                    const std::uint32_t number = grid.brick_at(grid.first_brick + b);
                    if (number == Grid::kEmpty) continue;
                    for (const float density : grid.brick(number)) {
                        sum += weight * static_cast<double>(density);
                    }
                    bricks.list.push_back({v, grid.first_brick + b, sum});
                }
            }
        }
    }
    return bricks;
}

// A point drawn in proportion to extinction [m].
glm::vec3 draw_point(const Bricks& bricks, std::span<const formats::Volume> volumes,
                     const std::array<float, 4>& u, const std::array<float, 4>& jitter) {
    const double wanted = static_cast<double>(u[0]) * bricks.list.back().before_and_own;
    const auto brick =
        std::ranges::upper_bound(bricks.list, wanted, {}, &Bricks::Brick::before_and_own);
    const Bricks::Brick& own = brick == bricks.list.end() ? bricks.list.back() : *brick;
    const Grid& grid = volumes[own.volume].density;
    const std::span<const float> value = grid.brick(grid.brick_at(own.place));
    double sum = 0;
    for (const float density : value) {
        sum += static_cast<double>(density);
    }
    double left = static_cast<double>(u[1]) * sum;
    std::size_t voxel = 0, last = 0;
    for (; voxel < value.size(); ++voxel) {
        left -= static_cast<double>(value[voxel]);
        last = value[voxel] > 0 ? voxel : last;
        if (left < 0) break;
    }
    const int at = static_cast<int>(voxel < value.size() ? voxel : last);
    constexpr int kSide = Grid::kSide;
    const glm::ivec3 index =
        kSide * own.place + glm::ivec3(at % kSide, at / kSide % kSide, at / (kSide * kSide));
    const glm::dvec3 place = glm::dvec3(index) + glm::dvec3(jitter[0], jitter[1], jitter[2]) - 0.5;
    return glm::vec3(grid.to_scene * glm::dvec4(place, 1.0));
}

glm::vec3 even_direction(float u, float v) {
    const float z = 1 - 2 * u, r = std::sqrt(std::max(0.0f, 1 - z * z));
    const float angle = 2 * std::numbers::pi_v<float> * v;
    return {r * std::cos(angle), r * std::sin(angle), z};
}

// At an angle of cosine `cosine` to `axis`.
glm::vec3 tilted(glm::vec3 axis, float cosine, float v) {
    const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
    const float angle = 2 * std::numbers::pi_v<float> * v;
    return glm::normalize(
        make_frame(axis).to_world({sine * std::cos(angle), sine * std::sin(angle), cosine}));
}

// Longer than any line within all volumes [m].
float extent_of(std::span<const formats::Volume> volumes) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const formats::Volume& volume : volumes) {
        for (const glm::dvec3& corner : volume.density.corners()) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
    }
    return static_cast<float>(1.01 * glm::length(high - low));
}

// The first surface that a picture shows: backs of opaque materials with one side are not there.
float find_end(const ReferenceScene& reference, glm::vec3 from, glm::vec3 direction) {
    const HitScene& surfaces = reference.surfaces;
    RayOrigin origin{from};
    for (std::uint32_t i = 0; i < kMostSteps; ++i) {
        const auto hit = surfaces.closest_hit(origin, direction, kForever);
        if (!hit) return kForever;
        const std::uint32_t material = surfaces.scene().primitives[hit->primitive].material;
        const bool is_culled = reference.medium_of[material] == formats::kNone &&
                               glm::dot(direction, hit->flat) > 0 &&
                               !surfaces.scene().materials[material].double_sided;
        if (!is_culled) return glm::dot(hit->position - from, direction);
        origin = go_straight_on(origin, leave_surface(*hit, direction));
    }
    return kForever;
}

VolumeRay ray_through(const ReferenceScene& reference, glm::vec3 point, glm::vec3 direction,
                      float extent) {
    VolumeRay ray{point - extent * direction, direction, kForever};
    if (const auto hit = reference.surfaces.closest_hit({point}, -direction, extent)) {
        // Paths start here without knowing the triangle: well clear of it.
        constexpr float kClear = 1e-4f;
        ray.origin = leave_surface(*hit, direction).position + kClear * extent * direction;
    }
    ray.end = find_end(reference, ray.origin, direction);
    return ray;
}

}  // namespace

std::vector<VolumeProbe> choose_volume_probes(const ReferenceScene& reference, std::uint32_t count,
                                              std::uint64_t seed) {
    const std::span<const formats::Volume> volumes = reference.surfaces.scene().volumes;
    const Bricks bricks = weigh_bricks(volumes);
    std::vector<VolumeProbe> probes;
    if (bricks.list.empty() || !(bricks.list.back().before_and_own > 0)) return probes;
    const float extent = extent_of(volumes);
    constexpr std::uint32_t kTries = 16, kPoint = 16;  // purposes below kPoint are directions
    for (std::uint32_t i = 0; i < count; ++i) {
        std::optional<glm::vec3> point;
        for (std::uint32_t t = 0; t < kTries && !point; ++t) {
            const glm::vec3 drawn = draw_point(bricks, volumes, draw(seed, i, kPoint + 2 * t),
                                               draw(seed, i, kPoint + 2 * t + 1));
            if (surrounding_media(reference, drawn, glm::vec3(0, 1, 0)).empty()) {
                point = drawn;
            }
        }
        if (!point) continue;
        VolumeProbe probe;
        const auto sun = draw(seed, i, 0), even = draw(seed, i, 1);
        probe.sun = even_direction(sun[0], sun[1]);
        // Cosines between the ray's direction and the sun's: of equal solid angle ahead and behind.
        constexpr std::array<std::array<float, 2>, 3> kCosines{
            {{0.5f, 1.0f}, {-0.5f, 0.5f}, {-1.0f, -0.5f}}};
        for (std::uint32_t place = 0; place < kCosines.size(); ++place) {
            const auto u = draw(seed, i, 2 + place);
            const float share = (static_cast<float>(i) + u[0]) / static_cast<float>(count);
            const auto [low, high] = kCosines[place];
            probe.ray[place] = ray_through(
                reference, *point, tilted(probe.sun, low + share * (high - low), u[1]), extent);
        }
        probe.ray[static_cast<std::size_t>(LightPlace::around)] =
            ray_through(reference, *point, even_direction(even[0], even[1]), extent);
        probes.push_back(probe);
    }
    return probes;
}

formats::Environment make_probe_sun(glm::vec3 direction) {
    constexpr float kRadius = 0.00465f;  // [rad]
    const auto radiance = static_cast<float>(std::numbers::pi / formats::disc_solid_angle(kRadius));
    formats::Environment light;
    light.discs.push_back(
        {{direction.x, direction.y, direction.z}, kRadius, {radiance, radiance, radiance}});
    return light;
}

formats::Environment make_even_light() {
    formats::Environment light;
    light.width = 4;
    light.height = 2;
    light.pixel.assign(std::size_t{light.width} * light.height, {1, 1, 1});
    return light;
}

std::vector<formats::Environment> make_volume_lights(std::span<const VolumeProbe> probes) {
    std::vector<formats::Environment> lights;
    for (const VolumeProbe& probe : probes) {
        lights.push_back(make_probe_sun(probe.sun));
    }
    lights.push_back(make_even_light());
    return lights;
}

formats::Result<VolumeTruth> trace_volume_truth(
    const ReferenceScene& reference, std::span<const VolumeProbe> probes, std::uint64_t seed,
    std::uint64_t max_events, const std::function<bool(const VolumeTruth&)>& is_enough,
    const Context& context, TermSet terms) {
    const std::vector<formats::Environment> lights = make_volume_lights(probes);
    std::vector<LightSampler> samplers;
    samplers.reserve(lights.size());
    for (const formats::Environment& light : lights) {
        samplers.push_back(make_light_sampler(light, glm::mat3(1.0f)));
    }
    PathOptions paths;
    paths.terms = terms;
    paths.by_volumes = true;
    const auto count = static_cast<std::uint32_t>(kLightPlaces * probes.size());
    const auto sample = [&](std::uint32_t pixel, RandomStream& random) {
        const std::size_t place = pixel / probes.size(), probe = pixel % probes.size();
        const LightSampler& sampler = samplers[light_number(probe, probes.size(), place)];
        const VolumeRay& ray = probes[probe].ray[place];
        PathSample one = trace_ray({reference, sampler, paths}, ray.origin, ray.direction, random);
        one.radiance =
            glm::vec3(formats::luminance({one.radiance.x, one.radiance.y, one.radiance.z}));
        return one;
    };
    VolumeTruth truth;
    truth.luminance.resize(count);
    truth.through = see_through_scene(reference.surfaces.scene().volumes, probes);
    EstimateOptions wanted;
    wanted.seed = seed;
    wanted.samples = 16;
    while (count > 0) {
        wanted.first = truth.samples;
        const auto estimate = estimate_pixels(count, wanted, context, sample);
        if (!estimate) return estimate.error();
        truth.samples += wanted.samples;
        truth.events += estimate->events;
        for (std::uint32_t i = 0; i < count; ++i) {
            truth.luminance[i].merge(estimate->pixel[i]);
        }
        if (is_enough(truth)) break;
        const double done = truth.samples;
        const double affordable = done * static_cast<double>(max_events) /
                                  static_cast<double>(std::max<std::uint64_t>(truth.events, 1));
        wanted.samples = static_cast<std::uint32_t>(std::clamp(affordable - done, 0.0, done));
        if (wanted.samples < truth.samples / 8 + 1) break;
    }
    return truth;
}

}  // namespace opaline::bake
