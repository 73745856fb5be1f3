#include "bake/effects/multiple/true_multiple.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bake/base/rng.h"
#include "bake/exchange/true_bounces.h"
#include "bake/receivers/surface_samples.h"

namespace opaline::bake {
namespace {

// A piece of a triangle small enough for the profile to be nearly constant on it.
struct Piece {
    std::uint32_t triangle;
    std::array<glm::vec3, 3> barycentric;
    double density;  // R_d at its centre [1/m^2]
};

double luminance_far(const GatherProfile& profile, float r2) {
    const std::array<float, 3> r = eval_far(profile, r2);
    return 0.2126 * static_cast<double>(r[0]) + 0.7152 * static_cast<double>(r[1]) +
           0.0722 * static_cast<double>(r[2]);
}

// Pieces of all triangles with the cumulative sum of R_d dA, split until each is small against its
// distance or the profile's length.
struct PieceTable {
    std::vector<Piece> pieces;
    std::vector<double> cumulative;
};

class Splitter {
  public:
    Splitter(const SurfaceIntegral& integral, glm::vec3 position, PieceTable& table)
        : integral_(integral), position_(position), table_(table) {}

    void add(std::uint32_t triangle) {
        triangle_ = triangle;
        split(integral_.triangles[triangle].corner, {glm::vec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}}, 0);
    }

  private:
    void split(const std::array<glm::vec3, 3>& x, const std::array<glm::vec3, 3>& b, int level) {
        constexpr int kDeepest = 24;
        constexpr float kShare = 0.5f;
        const glm::vec3 centre = (x[0] + x[1] + x[2]) / 3.0f;
        const float distance = glm::length(centre - position_);
        const float longest = std::max(
            {glm::length(x[1] - x[0]), glm::length(x[2] - x[1]), glm::length(x[0] - x[2])});
        if (longest > kShare * std::max(distance, integral_.smallest) && level < kDeepest) {
            const std::array<glm::vec3, 3> mid_x{0.5f * (x[0] + x[1]), 0.5f * (x[1] + x[2]),
                                                 0.5f * (x[2] + x[0])};
            const std::array<glm::vec3, 3> mid_b{0.5f * (b[0] + b[1]), 0.5f * (b[1] + b[2]),
                                                 0.5f * (b[2] + b[0])};
            split({x[0], mid_x[0], mid_x[2]}, {b[0], mid_b[0], mid_b[2]}, level + 1);
            split({mid_x[0], x[1], mid_x[1]}, {mid_b[0], b[1], mid_b[1]}, level + 1);
            split({mid_x[2], mid_x[1], x[2]}, {mid_b[2], mid_b[1], b[2]}, level + 1);
            split(mid_x, mid_b, level + 1);
            return;
        }
        const double density = luminance_far(integral_.profile, distance * distance);
        const double area =
            0.5 * static_cast<double>(glm::length(glm::cross(x[1] - x[0], x[2] - x[0])));
        if (density * area > 0) {
            const double before = table_.cumulative.empty() ? 0 : table_.cumulative.back();
            table_.pieces.push_back({triangle_, b, density});
            table_.cumulative.push_back(before + density * area);
        }
    }

    const SurfaceIntegral& integral_;
    glm::vec3 position_;
    PieceTable& table_;
    std::uint32_t triangle_ = 0;
};

glm::vec3 random_in(const Piece& piece, float u, float v) {
    // Folds the unit square's upper half over its lower.
    const bool fold = u + v > 1;
    const float s = fold ? 1 - u : u, t = fold ? 1 - v : v;
    return (1 - s - t) * piece.barycentric[0] + s * piece.barycentric[1] + t * piece.barycentric[2];
}

}  // namespace

SurfaceIntegral make_surface_integral(const formats::Scene& scene, std::uint32_t material,
                                      const MediumProfile& profile) {
    // Samples so dense that R_d is not split, except for the spike of normalised diffusion.
    constexpr double kSpacing = 1e-3;
    SurfaceIntegral integral;
    integral.bodies = SeparateBodies(scene, material);
    std::vector<std::uint32_t> primitives;
    glm::vec3 low(HUGE_VALF), high(-HUGE_VALF);
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        if (scene.primitives[p].material == material) {
            primitives.push_back(p);
        }
    }
    for (const AreaTable::Triangle& place : make_area_table(scene, primitives).triangle) {
        const formats::Primitive& p = scene.primitives[place.primitive];
        SurfaceIntegral::Triangle triangle{{}, place, 0};
        for (std::uint32_t k = 0; k < 3; ++k) {
            triangle.corner[k] = p.position[p.index[place.first_index + k]];
            low = glm::min(low, triangle.corner[k]);
            high = glm::max(high, triangle.corner[k]);
        }
        triangle.body = integral.bodies.body_at(triangle.corner[0]);
        integral.triangles.push_back(triangle);
    }
    integral.profile = make_gather_profile(
        profile, kSpacing * profile.smallest,
        integral.triangles.empty() ? 0.0 : static_cast<double>(glm::length(high - low)));
    integral.smallest = static_cast<float>(profile.smallest);
    double light = 0, all = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};
        light += kLuminance[b] * profile.total(b);
        all += kLuminance[b] * profile.total(b) * profile.all_orders[b];
    }
    integral.all_orders = light > 0 ? all / light : 1;
    integral.scale = 1 / (std::numbers::pi * profile.exit);
    integral.eta = profile.eta;
    return integral;
}

TwoEstimates integrate_multiple(const SurfaceIntegral& integral, const SurfaceLight& light,
                                glm::vec3 position, IntegralKey key, std::uint64_t& traced) {
    const auto& [scene, rays, suns, smooth, points, other] = light;
    const auto [seed, receiver] = key;
    const std::size_t lights = smooth.lights;
    TwoEstimates estimates{Luminance(lights), Luminance(lights)};
    if (integral.profile.table.empty()) return estimates;
    PieceTable table;
    table.pieces.reserve(integral.triangles.size());
    table.cumulative.reserve(integral.triangles.size());
    Splitter splitter(integral, position, table);
    const std::uint32_t body = integral.bodies.body_at(position);
    for (std::uint32_t t = 0; t < integral.triangles.size(); ++t) {
        if (integral.triangles[t].body == body) splitter.add(t);
    }
    if (table.pieces.empty()) return estimates;
    const double total = table.cumulative.back();
    Luminance irradiance(lights), diffuse(lights);
    std::uint32_t drawn = 0;
    for (Luminance* estimate : {&estimates.first, &estimates.second}) {
        const auto offset = static_cast<double>(
            random_uniform(seed, RandomStage::check_points, receiver, 2 * points + drawn)[0]);
        std::size_t at = 0;
        for (std::uint32_t i = 0; i < points; ++i, ++drawn) {
            const double place = (i + offset) / points * total;
            while (at + 1 < table.pieces.size() && table.cumulative[at] <= place) {
                ++at;
            }
            const Piece& piece = table.pieces[at];
            const auto u = random_uniform(seed, RandomStage::check_points, receiver, drawn);
            const SurfaceSample sample = make_surface_sample(
                scene,
                make_surface_point(scene, integral.triangles[piece.triangle].place,
                                   random_in(piece, u[0], u[1])),
                0);
            std::fill(irradiance.begin(), irradiance.end(), 0.0);
            traced += add_sun_irradiance(rays, suns, sample.receiver, integral.eta, irradiance);
            traced += add_smooth_irradiance(rays, smooth, sample.receiver, integral.eta,
                                            {u[2], u[3]}, irradiance);
            if (other != nullptr) {
                std::ranges::fill(diffuse, 0.0);
                traced += add_true_bounces(*other, sample.receiver,
                                           std::uint64_t{receiver} << 32 | drawn, 1, diffuse);
                const double entering = integral.all_orders / (std::numbers::pi * integral.scale);
                for (std::size_t l = 0; l < lights; ++l) {
                    irradiance[l] += entering * diffuse[l];
                }
            }
            const glm::vec3 d = sample.position - position;
            const double weight = integral.scale * total / points *
                                  luminance_far(integral.profile, glm::dot(d, d)) / piece.density;
            for (std::size_t l = 0; l < lights; ++l) {
                (*estimate)[l] += weight * irradiance[l];
            }
        }
    }
    return estimates;
}

}  // namespace opaline::bake
