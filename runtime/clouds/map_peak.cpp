#include "runtime/clouds/map_peak.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;
using std::numbers::pi;

constexpr double kStandOut = 4;      // threshold over surroundings
constexpr double kLeastFlux = 0.02;  // of pi times the mean luminance
constexpr double kRingBegin = 6 * pi / 180, kRingEnd = 12 * pi / 180;

// Of the angle from `centre`; accurate for small angles, where a cosine in float is not.
double squared_chord(Vec3 a, Vec3 b) {
    const Vec3 d = a - b;
    return static_cast<double>(dot(d, d));
}
double chord_of(double angle) {
    return 4 * std::pow(std::sin(0.5 * angle), 2);
}

struct Brightest {
    Vec3 direction;
    double luminance = 0;
};

// Outside of the rings around what was tried before; of equally bright pixels the highest.
Brightest find_brightest(const Environment& map, const std::vector<Vec3>& tried) {
    Brightest best;
    for_cells(map, [&](Rgb radiance, Vec3 direction, double) {
        const auto luminance = static_cast<double>(formats::luminance(radiance));
        if (luminance < best.luminance ||
            (luminance == best.luminance && direction.y <= best.direction.y)) {
            return;
        }
        for (const Vec3& place : tried) {
            if (squared_chord(direction, place) < chord_of(kRingEnd)) return;
        }
        best = {direction, luminance};
    });
    return best;
}

// Mean luminance of the map beyond the reach, and of the ring.
struct Surroundings {
    double map = 0, ring = 0;
};

Surroundings measure_surroundings(const Environment& map, Vec3 brightest) {
    double light = 0, area = 0, ring_light = 0, ring_area = 0;
    for_cells(map, [&](Rgb radiance, Vec3 direction, double solid_angle) {
        const double chord = squared_chord(direction, brightest);
        if (chord <= chord_of(kPeakReach)) return;
        const double part = solid_angle * static_cast<double>(formats::luminance(radiance));
        light += part;
        area += solid_angle;
        if (chord > chord_of(kRingBegin) && chord < chord_of(kRingEnd)) {
            ring_light += part;
            ring_area += solid_angle;
        }
    });
    return {area > 0 ? light / area : 0, ring_area > 0 ? ring_light / ring_area : 0};
}

// Direction, irradiance and radius from the pixels above the threshold.
void measure_light(const Environment& map, MapPeak& peak) {
    std::array<std::array<double, 3>, 3> moment{};  // [band][axis], of directions
    double flux = 0, spread = 0, weighted[3] = {};
    for_cells(map, [&](Rgb radiance, Vec3 direction, double solid_angle) {
        const double chord = squared_chord(direction, peak.brightest);
        if (chord > chord_of(kPeakReach)) return;
        const Rgb light = above_threshold(radiance, static_cast<float>(peak.threshold));
        const double weight = solid_angle * static_cast<double>(formats::luminance(light));
        const std::array<double, 3> bands{static_cast<double>(light.r),
                                          static_cast<double>(light.g),
                                          static_cast<double>(light.b)};
        const std::array<double, 3> axes{static_cast<double>(direction.x),
                                         static_cast<double>(direction.y),
                                         static_cast<double>(direction.z)};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            weighted[axis] += weight * axes[axis];
            for (std::size_t band = 0; band < 3; ++band) {
                moment[band][axis] += solid_angle * bands[band] * axes[axis];
            }
        }
        flux += weight;
        spread += weight * (chord + solid_angle / (2 * pi));  // a pixel spreads like a disc
    });
    const double norm = std::hypot(weighted[0], weighted[1], weighted[2]);
    if (!(norm > 0)) return;
    const std::array<double, 3> d{weighted[0] / norm, weighted[1] / norm, weighted[2] / norm};
    peak.direction = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
    const auto facing = [&](std::size_t band) {
        return static_cast<float>(std::max(
            0.0, moment[band][0] * d[0] + moment[band][1] * d[1] + moment[band][2] * d[2]));
    };
    peak.irradiance = {facing(0), facing(1), facing(2)};
    // Steiner: the spread about the centroid; a disc of radius r has r^2 / 2.
    const double about =
        std::max(spread / flux - squared_chord(peak.direction, peak.brightest), 0.0);
    peak.radius = std::sqrt(2 * about);
}

}  // namespace

std::optional<MapPeak> find_peak(const Environment& map) {
    constexpr int kTries = 8;
    std::vector<Vec3> tried;
    std::optional<MapPeak> strongest;
    double most = 0;
    for (int i = 0; i < kTries; ++i) {
        const Brightest brightest = find_brightest(map, tried);
        if (!(brightest.luminance > 0)) break;
        const Surroundings around = measure_surroundings(map, brightest.direction);
        MapPeak peak;
        peak.brightest = brightest.direction;
        peak.threshold = kStandOut * std::max(around.map, around.ring);
        if (brightest.luminance > 2 * peak.threshold) {
            measure_light(map, peak);
            const auto irradiance = static_cast<double>(formats::luminance(peak.irradiance));
            if (irradiance > most && irradiance >= kLeastFlux * pi * around.map) {
                strongest = peak;
                most = irradiance;
            }
        } else if (brightest.luminance <= 2 * kStandOut * around.map) {
            break;  // darker pixels exceed their surroundings by less
        }
        tried.push_back(brightest.direction);
    }
    return strongest;
}

Rgb above_threshold(Rgb radiance, float threshold) {
    const float luminance = formats::luminance(radiance);
    return luminance > threshold ? (1 - threshold / luminance) * radiance : Rgb{};
}

std::optional<formats::Environment> refine_map(const formats::Environment& map) {
    constexpr double kLargest = 3 * std::numbers::pi / 180;
    if (pixel_size(map).larger <= kLargest) return std::nullopt;
    formats::Environment fine;
    fine.width = 256;
    fine.height = 128;
    fine.pixel.resize(std::size_t{fine.width} * fine.height);
    std::vector<formats::Rgb> pixel;
    pixel.reserve(fine.pixel.size());
    for_cells(fine, [&](formats::Rgb, formats::Vec3 direction, double) {
        pixel.push_back(formats::sample_map(map, direction));
    });
    fine.pixel = std::move(pixel);
    return fine;
}

}  // namespace opaline::runtime
