#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bake/effects/single/ray_single.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "formats/opal/spherical_harmonics.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace opaline::tests {

/// A scene with all inputs of a gather.
struct SingleSetup {
    Scene scene;
    bake::RayScene rays;
    std::vector<bake::BodyPoint> points;
    bake::SingleMedium medium;
};

inline SingleSetup set_up(Scene scene, std::uint32_t depth_samples = 8) {
    auto rays = bake::RayScene::build(scene, 1);
    EXPECT_TRUE(rays);
    auto points = bake::make_body_points(scene, bake::make_vertex_receivers(scene));
    auto medium = bake::make_single_medium(scene, 0, depth_samples);
    return {std::move(scene), std::move(rays).value(), std::move(points), std::move(medium)};
}

/// The vertex nearest to a position.
inline std::size_t vertex_at(const SingleSetup& setup, glm::vec3 position) {
    std::size_t best = 0;
    for (std::size_t p = 1; p < setup.points.size(); ++p) {
        if (glm::distance(setup.points[p].position, position) <
            glm::distance(setup.points[best].position, position)) {
            best = p;
        }
    }
    return best;
}

/// Its points as receivers that see nothing of the outside.
inline std::vector<bake::ReceiverSet> receivers_of(const SingleSetup& setup) {
    std::vector<bake::ReceiverSet> sets(1);
    sets[0].inside = setup.points;
    sets[0].outside.resize(setup.points.size());
    return sets;
}

inline std::vector<float> gather(const SingleSetup& setup, const bake::DirectionSet& directions,
                                 std::size_t point, bake::EntryCounts* counts = nullptr) {
    const std::size_t n = directions.cubemap_size;
    std::vector<float> transport(18 * n * n * setup.medium.phase.count());
    const auto counted = bake::gather_single(setup.rays, directions, bake::texel_shares(directions),
                                             setup.medium, setup.points[point], transport);
    if (counts != nullptr) {
        *counts = counted;
    }
    return transport;
}

/// sum_k h_k(w_o') T_k from the rows of all terms; `inside`: w_o', refracted.
inline std::vector<float> seen_from(const std::vector<float>& transport, std::uint32_t terms,
                                    glm::vec3 inside) {
    std::vector<float> h(terms, 1.0f);
    if (terms > 1) {
        formats::eval_spherical_harmonics({inside.x, inside.y, inside.z}, h);
    }
    std::vector<float> seen(transport.size() / terms, 0.0f);
    for (std::size_t i = 0; i < transport.size(); ++i) {
        seen[i % seen.size()] += h[i / seen.size()] * transport[i];
    }
    return seen;
}

/// <T, 1> of each channel over all directions.
inline glm::dvec3 dot_one(const std::vector<float>& transport,
                          const bake::DirectionSet& directions) {
    glm::dvec3 sum(0);
    const std::size_t texels = transport.size() / 3;
    for (std::size_t j = 0; j < transport.size(); ++j) {
        sum[static_cast<glm::length_t>(j / texels)] +=
            transport[j] / directions.inverse_solid_angle[j % texels];
    }
    return sum;
}

/// Sixteen directions evenly around `axis` that make the given cosine with it, as the only block
/// of a set whose first texel they all belong to.
inline bake::DirectionSet make_cone(glm::vec3 axis, double cosine) {
    const glm::dvec3 n = axis;
    const glm::dvec3 u = glm::normalize(
        glm::cross(n, std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 v = glm::cross(n, u);
    bake::DirectionSet set;
    set.cubemap_size = 8;
    set.inverse_solid_angle.assign(384, 1.0f);
    bake::DirectionBlock block{};
    for (std::uint32_t lane = 0; lane < bake::RayPacket::kSize; ++lane) {
        const double phi = 2 * std::numbers::pi * (lane + 0.37) / bake::RayPacket::kSize;
        const double sine = std::sqrt(1 - cosine * cosine);
        const glm::vec3 w = glm::vec3(cosine * n + sine * (std::cos(phi) * u + std::sin(phi) * v));
        block.dir_x[lane] = w.x, block.dir_y[lane] = w.y, block.dir_z[lane] = w.z;
        block.moment_x[lane] = w.x, block.moment_y[lane] = w.y, block.moment_z[lane] = w.z;
    }
    set.blocks.push_back(block);
    return set;
}

/// A closed, bumpy, partly self-shadowing body.
inline Primitive make_bumpy_body(int levels, float bumps = 0.25f) {
    auto ball = make_sphere(levels);
    for (std::size_t v = 0; v < ball.position.size(); ++v) {
        const glm::vec3 n = ball.normal[v];
        ball.position[v] +=
            bumps * std::sin(5 * n.x + 1) * std::sin(6 * n.y) * std::sin(4 * n.z + 2) * n;
        ball.normal[v] = glm::vec3(0);
    }
    for (std::size_t i = 0; i < ball.index.size(); i += 3) {
        const glm::vec3 a = ball.position[ball.index[i]], b = ball.position[ball.index[i + 1]],
                        c = ball.position[ball.index[i + 2]];
        for (std::size_t k = 0; k < 3; ++k) {
            ball.normal[ball.index[i + k]] += glm::cross(b - a, c - a);
        }
    }
    for (glm::vec3& n : ball.normal) {
        n = glm::normalize(n);
    }
    return ball;
}

}  // namespace opaline::tests
