#include "bake/effects/multiple/walks/walk_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bake/effects/multiple/walks/find_hit.h"
#include "bake/scattering/fresnel.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

std::vector<WalkBands> group_bands(const formats::Medium& medium, bool grey) {
    // Walks of media whose extinctions differ by less are the same to rounding.
    constexpr float kSame = 1e-5f;
    const std::array<float, 3> sigma_s{medium.sigma_s.r, medium.sigma_s.g, medium.sigma_s.b};
    const std::array<float, 3> sigma_a{medium.sigma_a.r, medium.sigma_a.g, medium.sigma_a.b};
    std::vector<WalkBands> groups;
    for (std::size_t b = 0; b < (grey ? 1 : 3); ++b) {
        const float sigma_t = sigma_s[b] + sigma_a[b];
        if (!(sigma_s[b] > 0)) {
            continue;
        }
        auto group = std::find_if(groups.begin(), groups.end(), [&](const WalkBands& g) {
            return std::abs(g.sigma_t - sigma_t) <= kSame * sigma_t;
        });
        if (group == groups.end()) {
            group = groups.insert(groups.end(), {sigma_t, {}, {}});
        }
        group->albedo[b] = sigma_s[b] / sigma_t;
        group->member[b] = true;
    }
    return groups;
}

int count_along(const WalkSpace& space, glm::vec3 point, glm::vec3 direction) {
    constexpr int kMostCrossings = 10000;  // ends a line that rounding holds up
    int shells = 0;
    WalkHit hit;
    for (int i = 0; i < kMostCrossings &&
                    find_hit(space, point, direction, std::numeric_limits<float>::infinity(), hit);
         ++i) {
        const bool leaves = glm::dot(direction, hit.flat) > 0;
        if (hit.is_own) {
            shells += leaves ? 1 : -1;
        }
        point = hit.position + (leaves ? 2 : -2) * hit.error * hit.flat;
    }
    return shells;
}

}  // namespace

WalkSpace make_walk_space(const formats::Scene& scene, const EmbreeScene& triangles,
                          std::uint32_t material, bool grey) {
    const formats::Medium& medium = *scene.materials[material].medium;
    WalkSpace space;
    space.scene = &scene;
    space.triangles = &triangles;
    space.material = material;
    space.eta = medium.eta;
    space.is_grey = grey;
    space.phase = make_phase_table(medium.phase);
    space.bands = group_bands(medium, grey);
    if (medium.variation && !space.bands.empty()) {
        space.field.emplace(scene, material);
    }
    // Three that are effectively isotropic (README.md, "The light at an exit").
    space.diffuse_after = static_cast<std::uint32_t>(
        std::ceil(3 / (1 - std::min(0.999, std::abs(formats::mean_cosine(medium.phase))))));
    space.low = glm::vec3(std::numeric_limits<float>::max());
    space.high = glm::vec3(std::numeric_limits<float>::lowest());
    for (const formats::Primitive& p : scene.primitives) {
        if (p.material == material) {
            for (const std::uint32_t i : p.index) {
                space.low = glm::min(space.low, p.position[i]);
                space.high = glm::max(space.high, p.position[i]);
            }
        }
    }
    if (!(space.low.x <= space.high.x)) {
        space.bands.clear();
        return space;
    }
    const glm::vec3 size = space.high - space.low;
    const float diagonal = glm::length(size);
    space.low -= glm::vec3(1e-3f * diagonal);
    space.high += glm::vec3(1e-3f * diagonal);
    constexpr float kCell = 0.01f;  // of the diagonal
    space.clearance = ClearanceGrid(scene, 0.5f * (space.low + space.high),
                                    0.5f * (space.high - space.low), kCell * diagonal);
    // The mean number of events in a cube of that diagonal as the albedo tends to 1 is
    // eta^2 4 V / (S mean_free_path escape) (README.md, "The estimator"); a hundred times that is
    // no walk that goes on for good.
    float densest = 0;
    for (const WalkBands& group : space.bands) {
        densest = std::max(densest, group.sigma_t);
    }
    const auto eta = static_cast<double>(medium.eta);
    const double escape = std::max(1e-3, 1 - fresnel_moments(eta).external);
    const double mean = std::max(1.0, eta * eta) * static_cast<double>(diagonal * densest) / escape;
    space.most_events = static_cast<std::uint32_t>(std::min(1000 + 100 * mean, 200000.0));
    return space;
}

int count_shells(const WalkSpace& space, glm::vec3 point, glm::vec3 direction) {
    // Along no axis, edge or diagonal of common models.
    const std::array<glm::vec3, 5> lines{direction,
                                         {0.36f, 0.48f, 0.8f},
                                         {-0.8f, 0.36f, -0.48f},
                                         {0.48f, -0.8f, 0.36f},
                                         {-0.64f, -0.48f, 0.6f}};
    std::array<int, lines.size()> found{};
    for (std::size_t l = 0; l < lines.size(); ++l) {
        found[l] = count_along(space, point, lines[l]);
        const auto end = found.begin() + static_cast<std::ptrdiff_t>(l);
        if (std::find(found.begin(), end, found[l]) != end) {
            return found[l];
        }
    }
    return found.front();
}

double transport_mean_free_path(const formats::Medium& medium) {
    const double g = formats::mean_cosine(medium.phase);
    double densest = 0;
    const auto visit = [&](float sigma_s, float sigma_a) {
        if (sigma_s > 0) {
            densest = std::max(
                densest, (1 - g) * static_cast<double>(sigma_s) + static_cast<double>(sigma_a));
        }
    };
    visit(medium.sigma_s.r, medium.sigma_a.r);
    visit(medium.sigma_s.g, medium.sigma_a.g);
    visit(medium.sigma_s.b, medium.sigma_a.b);
    return densest > 0 ? 1 / densest : 0;
}

}  // namespace opaline::bake
