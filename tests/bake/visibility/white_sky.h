#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/trace/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "tests/support/scenes.h"

namespace opaline::tests {

inline bake::RayScene build_rays(const Scene& scene) {
    auto rays = bake::RayScene::build(scene, 1);
    EXPECT_TRUE(rays);
    return std::move(rays).value();
}

/// Irradiance from each texel of n x n a face.
inline std::vector<float> gather_texels(const bake::RayScene& rays, const bake::Receiver& receiver,
                                        std::uint32_t n) {
    static std::map<std::uint32_t, bake::DirectionSet> sets;
    if (!sets.contains(n)) {
        sets[n] = bake::make_direction_set(n);
    }
    std::vector<float> transport(formats::cubemap_texels(n));
    bake::gather_irradiance(rays, sets[n], receiver, transport);
    return transport;
}

/// Irradiance under a sky of radiance 1 / pi: radiance over albedo under a white one.
inline double white_irradiance(const bake::RayScene& rays, const bake::Receiver& receiver,
                               std::uint32_t n) {
    const std::vector<float> transport = gather_texels(rays, receiver, n);
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    double sum = 0;
    for (std::size_t j = 0; j < transport.size(); ++j) {
        sum += static_cast<double>(transport[j]) * solid_angle[j % solid_angle.size()];
    }
    return sum / std::numbers::pi;
}

/// Distance from `origin` along a ray to the nearest triangle beyond `near` [Moeller1997];
/// infinite: there is none.
inline double brute_force_distance(const Scene& scene, glm::dvec3 origin, glm::dvec3 d,
                                   double near) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Primitive& primitive : scene.primitives) {
        for (std::size_t i = 0; i < primitive.index.size(); i += 3) {
            const auto corner = [&](std::size_t k) {
                return glm::dvec3(primitive.position[primitive.index[i + k]]);
            };
            const glm::dvec3 ab = corner(1) - corner(0), ac = corner(2) - corner(0);
            const glm::dvec3 from = origin - corner(0), p = glm::cross(d, ac);
            const double determinant = glm::dot(ab, p);
            if (determinant == 0) continue;
            const double u = glm::dot(from, p) / determinant;
            const glm::dvec3 q = glm::cross(from, ab);
            const double v = glm::dot(d, q) / determinant, t = glm::dot(ac, q) / determinant;
            if (u >= 0 && v >= 0 && u + v <= 1 && t > near) {
                nearest = std::min(nearest, t);
            }
        }
    }
    return nearest;
}

}  // namespace opaline::tests
