#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bake/effects/multiple/walks/walk.h"
#include "bake/physics/gauss_legendre.h"
#include "tests/support/media.h"

namespace opaline::tests {

/// A body and what walks need to know of it.
struct WalkedBody {
    Scene scene;
    std::optional<bake::EmbreeScene> triangles;
    bake::WalkSpace space;
};

/// `inner`: media that walks pass through as well. `grey`: one band stands for all.
inline std::unique_ptr<WalkedBody> make_walked_scene(Scene scene, bool grey = true,
                                                     std::span<const std::uint32_t> inner = {}) {
    auto walked = std::make_unique<WalkedBody>();
    walked->scene = std::move(scene);
    walked->triangles.emplace(bake::EmbreeScene::build(walked->scene, 1, true).value());
    walked->space = bake::make_walk_space(walked->scene, *walked->triangles, 0, grey, inner);
    return walked;
}
inline std::unique_ptr<WalkedBody> make_walked_body(Primitive body, const formats::Medium& medium,
                                                    bool grey = true) {
    return make_walked_scene(make_translucent_scene({std::move(body)}, medium), grey);
}

/// A ball without its bottom, which lies below y = -0.9.
inline Primitive make_open_ball() {
    Primitive ball = make_sphere(3);
    const std::vector<std::uint32_t> all = std::exchange(ball.index, {});
    for (std::size_t i = 0; i < all.size(); i += 3) {
        if (ball.position[all[i]].y > -0.9f) {
            ball.index.insert(ball.index.end(), {all[i], all[i + 1], all[i + 2]});
        }
    }
    EXPECT_LT(ball.index.size(), all.size());
    return ball;
}

inline formats::Medium make_forward_medium(float sigma_t, float albedo, float g, float eta) {
    formats::Medium medium = make_grey_medium(albedo * sigma_t, (1 - albedo) * sigma_t, eta);
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    medium.phase.g = g;
    return medium;
}

/// Scattering alike in all directions.
inline formats::Medium make_coloured_medium(glm::vec3 sigma_s, glm::vec3 sigma_a) {
    formats::Medium medium = make_grey_medium(1, 1, 1.3f);
    medium.sigma_s = {sigma_s.r, sigma_s.g, sigma_s.b};
    medium.sigma_a = {sigma_a.r, sigma_a.g, sigma_a.b};
    return medium;
}

/// A slab between y = 0 and y = -thickness, practically without an end, and a start in its middle.
inline Primitive make_wide_slab(float thickness) {
    Primitive slab = make_cube(1, false);
    for (glm::vec3& p : slab.position) {
        p = (p + glm::vec3(0, -1, 0)) * glm::vec3(400, 0.5f, 400) * thickness;
    }
    return slab;
}

inline bake::WalkStart start_below(glm::vec3 point, glm::vec3 normal) {
    return {point - 1e-5f * normal, normal, normal, 1};
}

/// Chandrasekhar's H function of isotropic scatterers at the cosines of a Gauss-Legendre rule, by
/// its integral equation.
inline std::vector<double> chandrasekhar_h(double albedo, const bake::GaussLegendre& rule) {
    const double root = std::sqrt(1 - albedo);
    std::vector<double> h(rule.node.size(), 1.0);
    for (int pass = 0; pass < 2000; ++pass) {
        for (std::size_t i = 0; i < h.size(); ++i) {
            double sum = 0;
            for (std::size_t j = 0; j < h.size(); ++j) {
                sum += rule.weight[j] * rule.node[j] * h[j] / (rule.node[i] + rule.node[j]);
            }
            h[i] = 1 / (root + 0.5 * albedo * sum);
        }
    }
    return h;
}

/// Calls `visit(exits)` with all exits of each walk: one for every group of bands.
template <class Visit>
bake::WalkCounts visit_walks(const bake::WalkSpace& space, const bake::WalkStart& start,
                             const bake::WalkOrders& orders, std::uint32_t walks, Visit&& visit) {
    bake::WalkCounts counts;
    std::vector<bake::WalkExit> exits;
    for (std::uint32_t w = 0; w < walks; ++w) {
        exits.clear();
        for (bake::WalkGroup group; group.flies_as < space.bands.size(); ++group.flies_as) {
            bake::WalkRandom random({1, bake::RandomStage::body_walk, 7 + group.flies_as, w});
            bake::follow_walk(space, group, start, orders, random, exits, counts);
        }
        visit(std::as_const(exits));
    }
    return counts;
}

/// What leaves per walk: means over walks, with the standard error of the first.
struct Leaving {
    double all = 0, error = 0;
    double below = 0;  ///< through surfaces that face down
    bake::WalkCounts counts;
};

inline Leaving walk_from(const bake::WalkSpace& space, const bake::WalkStart& start,
                         std::uint32_t least, std::uint32_t walks) {
    Leaving leaving;
    double squares = 0;
    leaving.counts = visit_walks(space, start, {least}, walks, [&](const auto& exits) {
        double sum = 0;
        for (const bake::WalkExit& exit : exits) {
            sum += static_cast<double>(exit.weight[0]);
            leaving.below += exit.normal.y < 0 ? static_cast<double>(exit.weight[0]) / walks : 0;
        }
        leaving.all += sum / walks;
        squares += sum * sum / walks;
    });
    leaving.error = std::sqrt(std::max(0.0, squares - leaving.all * leaving.all) / walks);
    return leaving;
}

/// What leaves per walk, band by band: the mean and its standard error.
struct BandsLeaving {
    std::array<double, 3> mean{}, error{};
    bake::WalkCounts counts;
};

/// Through exits for which `counts` holds.
template <class Counts>
BandsLeaving walk_bands(const bake::WalkSpace& space, const bake::WalkStart& start,
                        std::uint32_t walks, Counts&& counts) {
    BandsLeaving leaving;
    leaving.counts = visit_walks(space, start, {1}, walks, [&](const auto& exits) {
        for (std::size_t b = 0; b < 3; ++b) {
            double sum = 0;
            for (const bake::WalkExit& exit : exits) {
                sum += counts(exit) ? static_cast<double>(exit.weight[b]) : 0;
            }
            leaving.mean[b] += sum / walks;
            leaving.error[b] += sum * sum / walks;
        }
    });
    for (std::size_t b = 0; b < 3; ++b) {
        const double variance = leaving.error[b] - leaving.mean[b] * leaving.mean[b];
        leaving.error[b] = std::sqrt(std::max(0.0, variance) / walks);
    }
    return leaving;
}

}  // namespace opaline::tests
