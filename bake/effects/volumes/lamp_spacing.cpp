#include "bake/effects/volumes/lamp_spacing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "bake/effects/volumes/volume_effects.h"
#include "bake/exchange/lamps/lamps.h"
#include "bake/exchange/lamps/point_box.h"
#include "bake/plan/plan_input.h"

namespace opaline::bake {
namespace {

using DensityGrid = formats::SparseGrid<float>;

// From where light comes: a point, the beam of a spot, or a box of surfaces.
struct LampPlace {
    PointBox box;
    glm::dvec3 axis{0};
    double outer = 0;  // [rad]; 0: no beam
};

std::vector<LampPlace> places_of(const formats::Scene& scene) {
    std::vector<LampPlace> places;
    for (const Lamp& lamp : list_lamps(scene)) {
        for (const std::uint32_t i : lamp.lights) {
            const formats::Light& light = scene.lights[i];
            if (light.type == formats::Light::Type::directional) continue;
            LampPlace& own = places.emplace_back();
            own.box.include(glm::dvec3(light.position));
            if (light.type != formats::Light::Type::spot) continue;
            own.axis = glm::dvec3(light.direction);
            own.outer = double{light.outer_cone};
        }
        for (const std::uint32_t p : lamp.primitives) {
            LampPlace& own = places.emplace_back();
            for (const glm::vec3& position : scene.primitives[p].position) {
                own.box.include(glm::dvec3(position));
            }
        }
    }
    return places;
}

// Where a brick is.
struct BrickPlace {
    const glm::dmat4& to_scene;
    glm::dvec3 low;  // index coordinates of its first voxel

    glm::dvec3 at(const glm::dvec3& index) const {
        return glm::dvec3(to_scene * glm::dvec4(index, 1));
    }
};

// Length [m] over which the light of a lamp changes in a brick.
double scale_in(const LampPlace& lamp, const BrickPlace& brick) {
    const glm::dvec3 middle = lamp.box.centre();
    const glm::dvec3 seen(glm::inverse(brick.to_scene) * glm::dvec4(middle, 1));
    const glm::dvec3 nearest = brick.at(glm::clamp(seen, brick.low, brick.low + 8.0));
    const glm::dvec3 centre = brick.at(brick.low + 4.0), way = centre - middle;
    const auto distance_to = [&](const glm::dvec3& at) {
        return glm::length(at - glm::clamp(at, lamp.box.low, lamp.box.high));
    };
    const double distance = std::max(distance_to(nearest), 0.5 * distance_to(centre));
    if (!(lamp.outer > 0)) return distance + 0.5 * lamp.box.radius();
    const double far = glm::length(way), radius = glm::length(brick.at(brick.low) - centre);
    if (far <= radius) return distance;
    const double angle =
        std::acos(std::clamp(glm::dot(way, lamp.axis) / far, -1.0, 1.0)) - std::asin(radius / far);
    return angle > lamp.outer ? std::numeric_limits<double>::infinity()
                              : distance * std::min(1.0, 1.5 * std::tan(lamp.outer));
}

}  // namespace

std::vector<std::uint32_t> lamp_spacings(const formats::Scene& scene, const DensityGrid& density,
                                         const Knobs& knobs) {
    constexpr std::array<double, 4> kShare{0.75, 0.5, 0.35, 0.25};
    const double share = kShare[static_cast<std::size_t>(knobs.quality)];
    std::vector<std::uint32_t> spacing;
    if (!is_wanted(knobs, kEmitters)) return spacing;
    const std::vector<LampPlace> places = places_of(scene);
    if (places.empty()) return spacing;
    double edge = 0;
    for (int axis = 0; axis < 3; ++axis) {
        edge = std::max(edge, glm::length(glm::dvec3(density.to_scene[axis])));
    }
    spacing.assign(density.brick_count(), 8);
    std::size_t cell = 0;
    for (glm::ivec3 b(0); b.z < density.extent.z; ++b.z) {
        for (b.y = 0; b.y < density.extent.y; ++b.y) {
            for (b.x = 0; b.x < density.extent.x; ++b.x) {
                const std::uint32_t number = density.table[cell++];
                if (number == DensityGrid::kEmpty) continue;
                const BrickPlace brick{density.to_scene, 8.0 * glm::dvec3(density.first_brick + b)};
                double scale = std::numeric_limits<double>::infinity();
                for (const LampPlace& place : places) {
                    scale = std::min(scale, scale_in(place, brick));
                }
                while (spacing[number] > 1 && spacing[number] * edge > share * scale) {
                    spacing[number] /= 2;
                }
            }
        }
    }
    return spacing;
}

std::uint32_t typical_spacing(const std::vector<std::uint32_t>& of_bricks,
                              const DensityGrid& density, std::uint32_t spacing) {
    std::array<double, 9> mass{};  // by spacing
    for (std::uint32_t b = 0; b < of_bricks.size(); ++b) {
        const std::span<const float> values = density.brick(b);
        mass[of_bricks[b]] += std::accumulate(values.begin(), values.end(), 0.0);
    }
    const double all = mass[1] + mass[2] + mass[4] + mass[8];
    double closer = 0;
    for (std::uint32_t s = 1; s < spacing; s *= 2) {
        closer += mass[s];
        if (closer > 0.5 * all) return s;
    }
    return spacing;
}

}  // namespace opaline::bake
