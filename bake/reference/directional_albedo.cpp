#include "bake/reference/directional_albedo.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bake/reference/ggx.h"

namespace opaline::bake {
namespace {

// Even in the cube root of the cosine: the albedo changes fast near grazing.
constexpr std::size_t kCosines = 64, kRoughnesses = 64;
constexpr int kSteps = 32;
const double kLeastRoot = std::cbrt(kGrazingCosine);

struct Table {
    std::vector<DirectionalAlbedo> node;  ///< by roughness, then cosine

    Table() {
        node.reserve(kCosines * kRoughnesses);
        for (std::size_t r = 0; r < kRoughnesses; ++r) {
            for (std::size_t c = 0; c < kCosines; ++c) {
                const double root = kLeastRoot + (1 - kLeastRoot) * static_cast<double>(c) /
                                                     static_cast<double>(kCosines - 1);
                const double roughness =
                    static_cast<double>(r) / static_cast<double>(kRoughnesses - 1);
                node.push_back(
                    integrate_albedo(std::min(1.0, root * root * root), roughness, kSteps));
            }
        }
    }
};

// Between nodes i and i + 1 of `count`, at `t` of the way.
struct Place {
    std::size_t i;
    double t;
};
Place find_place(double share, std::size_t count) {
    const double x = std::clamp(share, 0.0, 1.0) * static_cast<double>(count - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), count - 2);
    return {i, x - static_cast<double>(i)};
}

DirectionalAlbedo mix(const DirectionalAlbedo& a, const DirectionalAlbedo& b, double t) {
    return {a.normal + t * (b.normal - a.normal), a.grazing + t * (b.grazing - a.grazing)};
}

}  // namespace

DirectionalAlbedo integrate_albedo(double cosine, double roughness, int steps) {
    const double alpha = ggx_alpha(roughness);
    const glm::dvec3 o(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine);
    DirectionalAlbedo sum;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            // Crowded at the rim, u = 1 - (1 - s)^2, where the steepest normals are. v is a half
            // turn from -90 degrees: the plane of o and the normal is a mirror.
            const double rest = 1 - (i + 0.5) / steps, u = 1 - rest * rest;
            const double v = 0.5 * (j + 0.5) / steps - 0.25;
            const glm::dvec3 h = sample_visible_normal(o, alpha, u, v);
            const double o_h = glm::dot(o, h), c_l = 2 * o_h * h.z - o.z;
            if (c_l > 0) {
                const double kept = 2 * rest * smith_shadowing(cosine, c_l, alpha);
                const double weight = schlick_weight(o_h);
                sum.normal += (1 - weight) * kept;
                sum.grazing += weight * kept;
            }
        }
    }
    const double count = static_cast<double>(steps) * steps;
    return {sum.normal / count, sum.grazing / count};
}

DirectionalAlbedo directional_albedo(double cosine, double roughness) {
    static const Table table;
    const Place c = find_place(
        (std::cbrt(std::max(cosine, kGrazingCosine)) - kLeastRoot) / (1 - kLeastRoot), kCosines);
    const Place r = find_place(roughness, kRoughnesses);
    const DirectionalAlbedo* row = &table.node[r.i * kCosines + c.i];
    const DirectionalAlbedo* next = row + kCosines;
    return mix(mix(row[0], row[1], c.t), mix(next[0], next[1], c.t), r.t);
}

}  // namespace opaline::bake
