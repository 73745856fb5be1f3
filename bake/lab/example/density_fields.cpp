#include "bake/lab/example/density_fields.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/noise.hpp>
#include <numbers>
#include <vector>

#include "formats/fill_grid.h"

namespace opaline::bake {
namespace {

constexpr double kPi = std::numbers::pi;

// Gradient noise repeats after 289 units; no field here is so wide. Offsets keep the zeros of the
// octaves apart.
double fractal_noise(glm::dvec3 p, int octaves) {
    double sum = 0, weight = 0.5;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * glm::perlin(p + glm::dvec3(17.3 * i + 100, 31.7 * i + 50, 11.9 * i + 80));
        p *= 2.03;
        weight *= 0.5;
    }
    return sum;
}

// The same of absolute values: round bulges that meet in creases.
double billows(glm::dvec3 p, int octaves) {
    double sum = 0, weight = 0.5;
    for (int i = 0; i < octaves; ++i) {
        sum += weight *
               std::abs(glm::perlin(p + glm::dvec3(23.1 * i + 90, 7.7 * i + 60, 41.3 * i + 70)));
        p *= 2.1;
        weight *= 0.5;
    }
    return sum;
}

double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

struct Puff {
    glm::dvec3 centre;
    double radius;
};

// Three heaps of puffs that stand together, the tallest off the middle: large puffs inside, small
// ones on the slopes and around the foot.
std::vector<Puff> make_puffs() {
    struct Heap {
        double x, z, radius, height;
    };
    constexpr Heap kHeaps[] = {{-40, 0, 230, 300}, {190, 60, 180, 170}, {-250, -30, 150, 110}};
    constexpr int kCount = 56;  // of each
    std::vector<Puff> puffs;
    for (const Heap& heap : kHeaps) {
        for (int i = 0; i < kCount; ++i) {
            // Evenly spread, yet without a pattern: multiples of irrational numbers [Roberts2018].
            const auto spread = [i](double step) { return std::fmod(0.5 + step * i, 1.0); };
            const double share = std::sqrt((i + 0.5) / kCount);
            const double turn = 2 * kPi * spread(0.6180339887) + heap.x;
            const double radius =
                heap.radius * (0.17 + 0.18 * (1 - share)) * (0.8 + 0.4 * spread(0.7548776662));
            const double dome = std::sqrt(1 - share * share);
            const double y = 0.6 * radius + heap.height * dome * std::sqrt(spread(0.5698402910));
            puffs.push_back({{heap.x + heap.radius * share * std::cos(turn), y,
                              heap.z + heap.radius * share * std::sin(turn)},
                             radius});
        }
    }
    return puffs;
}

// Distance [m] outside of all puffs, which run into one another; negative inside.
double distance_to(const std::vector<Puff>& puffs, glm::dvec3 p) {
    double nearest = 1e9;
    for (const Puff& puff : puffs) {
        nearest = std::min(nearest, glm::length(p - puff.centre) - puff.radius);
    }
    return nearest;
}

}  // namespace

formats::SparseGrid<float> make_smoke_density(double base) {
    constexpr double kVoxel = 0.004, kHeight = 0.5;
    const auto density = [base](glm::ivec3 voxel) {
        glm::dvec3 p = kVoxel * glm::dvec3(voxel) - glm::dvec3(0, base, 0);
        const double h = p.y / kHeight;
        if (h < 0 || h > 1) return 0.0;
        // The column sways, and eddies pull it apart the more the higher it has come.
        p.x -= 0.05 * h * std::sin(2.2 * kPi * h + 0.4);
        p.z -= 0.04 * h * std::sin(1.7 * kPi * h + 1.9);
        const glm::dvec3 q = p / 0.05;
        const double strength = 0.075 * smooth_step(0, 0.8, h);
        p.x += strength * fractal_noise(q, 4);
        p.z += strength * fractal_noise(q + glm::dvec3(40, 13, 7), 4);
        const double radius = 0.012 + 0.075 * std::pow(h, 0.8);
        const double r = std::hypot(p.x, p.z) / radius;
        const double body = std::max(0.0, 1 - smooth_step(0.35, 1.0, r));
        const double wisps =
            std::clamp(1 - 1.8 * smooth_step(0, 0.6, h) * billows(1.3 * q, 3), 0.0, 1.0);
        const double fade = smooth_step(0, 0.03, h) * (1 - smooth_step(0.75, 1.0, h));
        // The same smoke in a wider column is thinner.
        return body * wisps * fade * std::min(1.0, 0.03 / radius);
    };
    const int top = static_cast<int>((base + kHeight) / kVoxel) + 1;
    return formats::fill_grid({-50, static_cast<int>(base / kVoxel) - 1, -50}, {50, top, 50},
                              kVoxel, density);
}

namespace {

constexpr double kFireVoxel = 0.006, kFireHeight = 0.6;

// How far inside of the flames a point is: 1 at their heart, 0 where they end.
double flame_at(glm::dvec3 p) {
    const double h = p.y / 0.36;
    if (h < 0 || h > 1) return 0;
    // Tongues lick: noise that is stretched upward pulls apart what would be a cone.
    const glm::dvec3 q(p.x / 0.045, p.y / 0.12, p.z / 0.045);
    const double strength = 0.06 * smooth_step(0, 0.6, h);
    p.x += strength * fractal_noise(q, 3);
    p.z += strength * fractal_noise(q + glm::dvec3(17, 5, 29), 3);
    const double tongues =
        1 - 1.1 * smooth_step(0.05, 0.8, h) * billows(q + glm::dvec3(3, 8, 1), 2);
    const double radius = 0.11 * std::sqrt(1 - h) * (0.6 + 0.4 * smooth_step(0, 0.12, h));
    const double r = std::hypot(p.x, p.z) / (radius * std::max(tongues, 0.05));
    return (1 - smooth_step(0.4, 1.0, r)) * smooth_step(0, 0.03, h);
}

// Smoke that rises from them.
double fire_smoke_at(glm::dvec3 p) {
    const double h = p.y / kFireHeight;
    if (h < 0.1 || h > 1) return 0;
    p.x -= 0.1 * h * h;
    const glm::dvec3 q = p / 0.07;
    p.x += 0.1 * h * fractal_noise(q, 4);
    p.z += 0.1 * h * fractal_noise(q + glm::dvec3(40, 13, 7), 4);
    const double radius = 0.09 + 0.09 * h;
    const double body = std::max(0.0, 1 - smooth_step(0.4, 1.0, std::hypot(p.x, p.z) / radius));
    const double wisps = std::clamp(1.1 - 1.3 * billows(1.2 * q, 3), 0.0, 1.0);
    return body * wisps * smooth_step(0.25, 0.6, h) * (1 - smooth_step(0.8, 1.0, h));
}

template <class Value>
formats::SparseGrid<float> fill_fire(Value&& value) {
    const int side = 35, top = static_cast<int>(kFireHeight / kFireVoxel) + 1;
    return formats::fill_grid({-side, 0, -side}, {side, top, side}, kFireVoxel,
                              [&](glm::ivec3 v) { return value(kFireVoxel * glm::dvec3(v)); });
}

}  // namespace

formats::SparseGrid<float> make_fire_density() {
    return fill_fire([](glm::dvec3 p) { return 0.25 * flame_at(p) + 0.5 * fire_smoke_at(p); });
}

formats::SparseGrid<float> make_fire_temperature() {
    return fill_fire([](glm::dvec3 p) {
        const double flame = flame_at(p);
        return flame > 0 ? 1200 + 700 * std::sqrt(flame) * (1 - 0.4 * p.y / 0.36) : 0.0;
    });
}

formats::SparseGrid<float> make_cumulus_density(double voxel) {
    constexpr double kBulge = 60;
    const std::vector<Puff> puffs = make_puffs();
    const auto density = [&](glm::ivec3 index) {
        const glm::dvec3 p = voxel * glm::dvec3(index);
        const double plain = distance_to(puffs, p);
        if (plain > 0.4 * kBulge) return 0.0;
        const double d =
            plain + kBulge * (0.5 - 1.4 * billows(p / 110.0, 4)) + 10 * fractal_noise(p / 25.0, 2);
        const double base = smooth_step(-4, 14, p.y - 8 * fractal_noise(p / 90.0, 2));
        return (1 - smooth_step(-14, 6, d)) * base * (0.45 + 0.55 * std::min(1.0, p.y / 350));
    };
    const glm::ivec3 half(glm::dvec3(480, 450, 360) / voxel);
    return formats::fill_grid({-half.x, 0, -half.z}, half, voxel, density);
}

formats::SparseGrid<float> make_block_density() {
    constexpr double kVoxel = 5e-5;
    // Density falls to 0 over one voxel beyond the last ones: half a voxel of the edge.
    return formats::fill_grid({-29, 1, -19}, {30, 30, 20}, kVoxel, [](glm::ivec3) { return 1.0; });
}

formats::SparseGrid<float> make_noise_density() {
    constexpr double kVoxel = 0.016;
    const glm::dvec3 half(0.5, 0.34, 0.4);
    const auto density = [half](glm::ivec3 voxel) {
        const glm::dvec3 p = kVoxel * glm::dvec3(voxel) - glm::dvec3(0, half.y, 0);
        const double r = glm::length(p / half);
        if (r >= 1) return 0.0;
        const double noise = fractal_noise(p / 0.28, 5);
        return smooth_step(-0.12, 0.35, noise + 0.45 * (0.55 - r)) * (1 - smooth_step(0.8, 1, r));
    };
    return formats::fill_grid({-32, -1, -26}, {32, 43, 26}, kVoxel, density);
}

}  // namespace opaline::bake
