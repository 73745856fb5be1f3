#include "bake/effects/multiple/walks/true_walks.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "bake/effects/multiple/walks/walk.h"
#include "bake/exchange/true_bounces.h"
#include "bake/physics/fresnel.h"
#include "bake/receivers/surface_samples.h"

namespace opaline::bake {
namespace {

constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};

// Luminance of the bands that a walk serves; all of it where the bands are equal.
double share_of(const WalkBands& bands, bool is_grey) {
    double share = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        share += bands.member[b] ? kLuminance[b] : 0;
    }
    return is_grey ? 1 : share;
}

// Luminance of an exit's weight per luminance of the light.
double luminance_of(const WalkExit& exit, bool is_grey) {
    double sum = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        sum += kLuminance[b] * static_cast<double>(exit.weight[b]);
    }
    return is_grey ? static_cast<double>(exit.weight[0]) : sum;
}

// What exits of each medium see, where walks leave other bodies than their own.
struct Boundary {
    ExitLobe lobe;
    double escape = 1;
};
std::vector<Boundary> boundaries_of(const WalkSpace& space) {
    std::vector<Boundary> all;
    for (const WalkMedium& medium : space.media) {
        const auto eta = static_cast<double>(medium.eta);
        all.push_back({make_exit_lobe(eta), 1 - fresnel_moments(eta).external});
    }
    return all;
}

// Light at an exit as the irradiance of even light that is as bright there. Hardly any exit meets a
// sun: they look at it through a lobe.
std::uint64_t add_light(const WalkLight& light, const Boundary& boundary, const SurfaceSample& at,
                        const WalkExit& exit, glm::vec2 u, std::span<double> irradiance) {
    const std::uint64_t rays =
        add_sun_irradiance(light.rays, light.suns, at.receiver, boundary.lobe.eta, irradiance,
                           boundary.lobe.eval(at.normal, exit.direction));
    if (glm::dot(at.normal, exit.direction) > 0) {
        return rays + add_smooth_radiance(light.rays, light.smooth, at.receiver, exit.direction,
                                          std::numbers::pi * boundary.escape, irradiance);
    }
    return rays + add_smooth_irradiance(light.rays, light.smooth, at.receiver, boundary.lobe.eta, u,
                                        irradiance);
}

}  // namespace

TwoEstimates walk_to_lights(const WalkSpace& space, const WalkLight& light, const BodyPoint& point,
                            WalkOrders orders, std::uint64_t seed, std::uint32_t key,
                            std::uint64_t& traced) {
    const std::size_t lights = light.smooth.lights;
    TwoEstimates estimates{Luminance(lights), Luminance(lights)};
    if (point.normal == glm::vec3(0) || space.bands.empty()) return estimates;
    const bool is_grey = space.is_grey;
    // As many walks fly as a group as the eye sees of it.
    WalkGroup group{0, {}};
    double shares = 0;
    for (std::size_t g = 0; g < space.bands.size(); ++g) {
        shares += share_of(space.bands[g], is_grey);
    }
    for (std::size_t g = 0; g < space.bands.size(); ++g) {
        group.walks[g] = static_cast<float>(share_of(space.bands[g], is_grey) / shares);
    }
    WalkStart start{point.inner, point.normal, point.normal,
                    std::max(1, count_shells(space, point.inner, -point.normal)), light.seen};
    start.vertex = point.position;
    if (space.bodies) {
        start.around = bodies_at_start(space, point.inner);
    }
    const Boundary own{light.lobe, light.escape};
    const std::vector<Boundary> others =
        space.bodies && space.media.size() > 1 ? boundaries_of(space) : std::vector<Boundary>();
    std::vector<WalkExit> exits;
    std::array<double, 3> seen_bands{};
    for (const WalkBands& bands : space.bands) {
        for (std::size_t b = 0; b < 3; ++b) {
            seen_bands[b] += bands.member[b] ? (is_grey ? 1 : kLuminance[b]) / shares : 0;
        }
    }
    const auto correction = [&](const WalkCounts& counts) {
        return counts.correction() * counts.crossed_correction(seen_bands);
    };
    Luminance irradiance(lights), diffuse(lights);
    std::uint32_t walk = 0;
    for (Luminance* estimate : {&estimates.first, &estimates.second}) {
        WalkCounts counts;
        for (std::uint32_t i = 0; i < light.walks; ++i, ++walk) {
            WalkRandom random({seed, RandomStage::true_body_walk, key, walk});
            float place = random.next();
            group.flies_as = 0;
            while (group.flies_as + 1 < space.bands.size() &&
                   place >= group.walks[group.flies_as]) {
                place -= group.walks[group.flies_as++];
            }
            exits.clear();
            follow_walk(space, group, start, orders, random, exits, counts);
            // One exit represents the walk, drawn in proportion to its weight.
            double sum = 0;
            const WalkExit* exit = nullptr;
            for (const WalkExit& e : exits) {
                const double weight = luminance_of(e, is_grey);
                sum += weight;
                if (static_cast<double>(random.next()) * sum < weight) {
                    exit = &e;
                }
            }
            if (exit == nullptr) continue;
            const SurfaceSample at = make_surface_sample(
                *space.scene,
                make_surface_point(*space.scene, {exit->primitive, exit->first_index},
                                   {1 - exit->u - exit->v, exit->u, exit->v}),
                0);
            std::ranges::fill(irradiance, 0.0);
            const glm::vec2 u{random.next(), random.next()};
            const Boundary& boundary = others.empty() || exit->material == space.material
                                           ? own
                                           : others[space.medium_of[exit->material]];
            if (!exit->is_once) {
                traced += add_light(light, boundary, at, *exit, u, irradiance);
            }
            if (light.other != nullptr) {
                std::ranges::fill(diffuse, 0.0);
                traced += add_true_bounces(*light.other, at.receiver,
                                           std::uint64_t{key} << 32 | walk, 1, diffuse);
                for (std::size_t l = 0; l < lights; ++l) {
                    irradiance[l] += boundary.escape * diffuse[l];
                }
            }
            const double weight = sum / (std::numbers::pi * boundary.escape * light.walks);
            for (std::size_t l = 0; l < lights; ++l) {
                (*estimate)[l] += weight * irradiance[l];
            }
        }
        for (double& value : *estimate) {
            value *= correction(counts);
        }
        traced += counts.rays;
    }
    return estimates;
}

}  // namespace opaline::bake
