#include "runtime/clouds/sky_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "runtime/clouds/map_peak.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;
using std::numbers::pi;

constexpr double kHorizonBand = 6 * pi / 180;

// The first moment of directions over the part of a disc above the horizon: y and horizontal.
struct Moment {
    double up = 0, across = 0;
};

// M = 1/2 oint w x dw, along the disc's rim and along the horizon. `sine` of the elevation of the
// centre, radius r in (0, pi / 2).
Moment moment_above_horizon(double sine, double r) {
    const double cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
    const double whole = pi * std::pow(std::sin(r), 2);
    // Rim at the angle phi from its highest point: height cos r sine + sin r cosine cos(phi).
    const double level = std::cos(r) * sine, swing = std::sin(r) * cosine;
    if (level >= swing) return {whole * sine, whole * cosine};
    if (level <= -swing) return {};
    const double phi = std::acos(-level / swing);
    const double half_width = std::sin(r) * std::sin(phi);
    const double horizon =
        std::atan2(half_width, std::cos(r) * cosine - std::sin(r) * sine * std::cos(phi));
    const double toward = phi * std::pow(std::sin(r), 2);  // the disc's centre
    const double tilt = std::sin(phi) * std::sin(r) * std::cos(r);
    return {std::max(0.0, toward * sine - tilt * cosine + horizon),
            std::max(0.0, toward * cosine + tilt * sine)};
}

// A disc as a sun; nothing if it does not reach above the horizon. `irradiance` facing all of it.
std::optional<LayerSun> raise_sun(Vec3 direction, Rgb irradiance, float radius) {
    const auto r = static_cast<double>(radius);
    const Moment moment = moment_above_horizon(static_cast<double>(direction.y), r);
    const double facing = std::hypot(moment.up, moment.across);
    const auto share = static_cast<float>(facing / (pi * std::pow(std::sin(r), 2)));
    LayerSun sun{direction, share * irradiance, radius};
    if (!(moment.up > 0) || !(formats::luminance(sun.irradiance) > 0)) return std::nullopt;
    const double level =
        std::hypot(static_cast<double>(direction.x), static_cast<double>(direction.z));
    const double scale = level > 0 ? moment.across / (facing * level) : 0;
    sun.direction =
        formats::normalize({static_cast<float>(scale * static_cast<double>(direction.x)),
                            static_cast<float>(moment.up / facing),
                            static_cast<float>(scale * static_cast<double>(direction.z))});
    return sun;
}

Rgb disc_irradiance(const formats::DistantDisc& disc) {
    const double facing = pi * std::pow(std::sin(static_cast<double>(disc.angular_radius)), 2);
    return static_cast<float>(facing) * disc.radiance;
}

// Suns of the discs; what remains of them is added to the sky's irradiance.
void add_discs(const Environment& environment, const Rotation& rotation, SkyLight& sky) {
    struct Candidate {
        LayerSun sun;
        std::uint32_t disc;
    };
    std::vector<Candidate> above;
    for (std::uint32_t i = 0; i < environment.discs.size(); ++i) {
        const formats::DistantDisc& disc = environment.discs[i];
        const auto sun = raise_sun(formats::normalize(rotation.world_from_light(disc.direction)),
                                   disc_irradiance(disc), disc.angular_radius);
        if (sun) above.push_back({*sun, i});
    }
    std::ranges::stable_sort(above, [](const Candidate& a, const Candidate& b) {
        return formats::luminance(a.sun.irradiance) > formats::luminance(b.sun.irradiance);
    });
    for (const Candidate& candidate : above) {
        if (sky.suns.size() < kMaxLayerSuns) {
            sky.suns.push_back(candidate.sun);
            sky.sun_discs.push_back(candidate.disc);
        } else {
            sky.irradiance = sky.irradiance + candidate.sun.direction.y * candidate.sun.irradiance;
        }
    }
}

void add_peak(const MapPeak& peak, const Rotation& rotation, SkyLight& sky) {
    const auto sun = raise_sun(formats::normalize(rotation.world_from_light(peak.direction)),
                               peak.irradiance, static_cast<float>(peak.radius));
    if (sun) sky.suns.push_back(*sun);
    sky.sun_luminance = static_cast<float>(peak.threshold);
    sky.peak = rotation.world_from_light(peak.brightest);
    sky.peak_cosine = static_cast<float>(std::cos(kPeakReach));
}

// What the sun of the map takes of its radiance.
Rgb peak_part(const SkyLight& sky, Rgb radiance, Vec3 direction) {
    return dot(direction, sky.peak) > sky.peak_cosine ? above_threshold(radiance, sky.sun_luminance)
                                                      : Rgb{};
}

Rgb without_peak(const SkyLight& sky, Rgb radiance, Vec3 direction) {
    return radiance + -1.0f * peak_part(sky, radiance, direction);
}

// On a horizontal plane.
Rgb rest_irradiance(const Environment& map, const Rotation& rotation, const SkyLight& sky) {
    std::array<double, 3> sum{};
    for_cells(map, [&](Rgb radiance, Vec3 direction, double solid_angle) {
        const Vec3 world = rotation.world_from_light(direction);
        if (!(world.y > 0)) return;
        const Rgb rest = without_peak(sky, radiance, world);
        const double weight = solid_angle * static_cast<double>(world.y);
        sum[0] += weight * static_cast<double>(rest.r);
        sum[1] += weight * static_cast<double>(rest.g);
        sum[2] += weight * static_cast<double>(rest.b);
    });
    return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

// At even steps of height, which are even steps of solid angle.
Rgb mean_near_horizon(const Environment& map, const Rotation& rotation, const SkyLight& sky) {
    constexpr int kTurns = 512, kHeights = 8;
    std::array<double, 3> sum{};
    for (int j = 0; j < kHeights; ++j) {
        const double y = std::sin(kHorizonBand) * (j + 0.5) / kHeights;
        const double across = std::sqrt(1 - y * y);
        for (int i = 0; i < kTurns; ++i) {
            const double phi = 2 * pi * (i + 0.5) / kTurns;
            const Vec3 world{static_cast<float>(across * std::cos(phi)), static_cast<float>(y),
                             static_cast<float>(across * std::sin(phi))};
            const Rgb rest = map_rest(sky, map, rotation, world);
            sum[0] += static_cast<double>(rest.r);
            sum[1] += static_cast<double>(rest.g);
            sum[2] += static_cast<double>(rest.b);
        }
    }
    const double share = 1.0 / (kTurns * kHeights);
    return {static_cast<float>(share * sum[0]), static_cast<float>(share * sum[1]),
            static_cast<float>(share * sum[2])};
}

// A point at the rim belongs to the disc, as in sample_radiance.
bool lies_in(const formats::DistantDisc& disc, Vec3 light_direction) {
    return length(light_direction - disc.direction) <= 2.0f * std::sin(0.5f * disc.angular_radius);
}

}  // namespace

SkyLight split_sky(const Environment& environment, const Rotation& rotation) {
    SkyLight sky;
    if (!environment.pixel.empty()) {
        const std::optional<Environment> fine = refine_map(environment);
        const Environment& map = fine ? *fine : environment;
        if (environment.discs.empty()) {
            if (const auto peak = find_peak(map)) add_peak(*peak, rotation, sky);
        }
        sky.irradiance = rest_irradiance(map, rotation, sky);
        sky.horizon = mean_near_horizon(environment, rotation, sky);
    }
    add_discs(environment, rotation, sky);
    return sky;
}

Rgb map_rest(const SkyLight& sky, const Environment& environment, const Rotation& rotation,
             Vec3 direction) {
    return without_peak(sky, formats::sample_map(environment, rotation.light_from_world(direction)),
                        direction);
}

Rgb rest_radiance(const SkyLight& sky, const Environment& environment, const Rotation& rotation,
                  Vec3 direction) {
    const Vec3 light = rotation.light_from_world(direction);
    Rgb rest = map_rest(sky, environment, rotation, direction);
    for (std::uint32_t i = 0; i < environment.discs.size(); ++i) {
        if (std::ranges::find(sky.sun_discs, i) == sky.sun_discs.end() &&
            lies_in(environment.discs[i], light)) {
            rest = rest + environment.discs[i].radiance;
        }
    }
    return rest;
}

Rgb sun_part(const SkyLight& sky, const Environment& environment, const Rotation& rotation,
             Vec3 direction) {
    const Vec3 light = rotation.light_from_world(direction);
    Rgb sun = peak_part(sky, formats::sample_map(environment, light), direction);
    for (const std::uint32_t i : sky.sun_discs) {
        if (lies_in(environment.discs[i], light)) sun = sun + environment.discs[i].radiance;
    }
    return sun;
}

}  // namespace opaline::runtime
