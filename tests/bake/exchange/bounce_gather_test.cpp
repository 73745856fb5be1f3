#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/scatterers.h"
#include "formats/opal/haar.h"
#include "tests/bake/exchange/bounce_support.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

std::vector<Scatterer> upper_plate(std::uint32_t side) {
    std::vector<Scatterer> all;
    for (std::uint32_t i = 0; i < side * side; ++i) {
        Scatterer s;
        s.position = {(static_cast<float>(i % side) + 0.5f) / static_cast<float>(side), 1,
                      (static_cast<float>(i / side) + 0.5f) / static_cast<float>(side)};
        s.normal = {0, -1, 0};
        s.material = 1;
        all.push_back(s);
    }
    return all;
}

// Form factor from the middle of a square to a parallel one at distance 1 and of edge 1: four
// times that of a corner, X = Y = 1/2:
//   F = 4 / (2 pi) (X / sqrt(1 + X^2) atan(Y / sqrt(1 + X^2)) + the same with X and Y exchanged).
TEST(BounceGather, SumOfWeightsIsTheFormFactor) {
    const formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    const RayScene rays = RayScene::build(scene, 1).value();
    const BounceTree tree(upper_plate(32), 2, 1);
    const double x = 0.5, root = std::sqrt(1 + x * x);
    const double expected = 4 / std::numbers::pi * x / root * std::atan(x / root);
    double sum = 0;
    std::vector<NodeWeight> weights;
    const BounceGather gathered = weigh_bounces(
        {scene, rays}, tree, {{0.5f, 1e-5f, 0.5f}, {0, 1, 0}}, make_bounce_grid(4096), 1, weights);
    EXPECT_EQ(gathered.rays, 4096u);
    // Of 1 / r^2, the integral of 1 / (pi r^6) over the plate.
    double nearness = 0;
    constexpr int kParts = 200;
    for (int i = 0; i < kParts * kParts; ++i) {
        const double u = (i % kParts + 0.5) / kParts - 0.5;
        const double v = (std::floor(static_cast<double>(i) / kParts) + 0.5) / kParts - 0.5;
        nearness += std::pow(1 + u * u + v * v, -3) / (kParts * kParts * std::numbers::pi);
    }
    EXPECT_NEAR(gathered.nearness, nearness, 0.003);
    for (const NodeWeight& w : weights) {
        sum += w.weight;
    }
    EXPECT_NEAR(sum, expected, 0.003);
}

// From a plate that looks away there is nothing to see.
TEST(BounceGather, BacksOfSingleSidedSurfacesSendNothing) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    const RayScene rays = RayScene::build(scene, 1).value();
    const BounceTree tree(upper_plate(4), 2, 1);
    std::vector<NodeWeight> weights;
    weigh_bounces({scene, rays}, tree, {{0.5f, 2, 0.5f}, {0, -1, 0}}, make_bounce_grid(256), 1,
                  weights);
    EXPECT_TRUE(weights.empty());
}

// A ray from the origin through a cell of width h, and where it meets a plane at distance t.
struct Met {
    static constexpr float h = 1 / 256.0f;
    glm::vec2 uv;
    glm::vec3 normal;  // of the plane, toward the ray
    float t;
    BounceCell cell;

    explicit Met(std::uint32_t i) {
        const auto u = random_uniform(9, RandomStage::bounce_rays, i);
        const auto w = random_uniform(9, RandomStage::bounce_rays, i, 1);
        uv = {0.02f + 0.96f * u[0], 0.02f + 0.96f * u[1]};
        t = 0.2f + 3 * w[0];
        cell.middle = through(0, 0);
        cell.across = through(h / 2, 0) - through(-h / 2, 0);
        cell.along = through(0, h / 2) - through(0, -h / 2);
        normal = glm::normalize(glm::vec3(0.3f * u[2], 0.3f * u[3], 1) - 2.0f * cell.middle);
    }
    glm::vec3 through(float du, float dv) const { return to_hemisphere(uv.x + du, uv.y + dv); }
    FootprintKernel footprint() const {
        const SeenSide side{true, false, normal, -glm::dot(cell.middle, normal)};
        return footprint_of({0, 0, 0},
                            {.direction = cell.middle, .distance = t, .side = side, .is_met = true},
                            cell, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
    }
    glm::vec3 on_plane(glm::vec3 direction) const {
        return t * glm::dot(cell.middle, normal) / glm::dot(direction, normal) * direction;
    }
};

// Directions through the edges of a ray's cell meet the surface half a width from its middle.
TEST(BounceGather, FootprintEndsWhereTheEdgesOfTheCellLand) {
    for (std::uint32_t i = 0; i < 200; ++i) {
        const Met met(i);
        const FootprintKernel kernel = met.footprint();
        const auto width = [&](float u, float v) {
            return met.on_plane(met.through(u, v)) - met.on_plane(met.through(-u, -v));
        };
        const float area = glm::length(glm::cross(width(Met::h / 2, 0), width(0, Met::h / 2)));
        EXPECT_NEAR(kernel.area / area, 1, 0.03) << i;
        for (const float sign : {-0.5f, 0.5f}) {
            const glm::vec3 a = met.on_plane(met.through(sign * Met::h, 0)) - kernel.centre;
            const glm::vec3 b = met.on_plane(met.through(0, sign * Met::h)) - kernel.centre;
            EXPECT_NEAR(glm::dot(a, kernel.across), sign, 0.03) << i;
            EXPECT_NEAR(glm::dot(a, kernel.along), 0, 0.03) << i;
            EXPECT_NEAR(glm::dot(b, kernel.along), sign, 0.03) << i;
            EXPECT_NEAR(glm::dot(b, kernel.across), 0, 0.03) << i;
            EXPECT_LE(0.5f, glm::length(a) * kernel.steepest * 1.03f) << i;
            for (glm::length_t axis = 0; axis < 3; ++axis) {
                EXPECT_LE(std::abs(a[axis]), 0.52f * kernel.extent[axis]) << i;
                EXPECT_LE(std::abs(b[axis]), 0.52f * kernel.extent[axis]) << i;
            }
        }
    }
}

// Coefficients of a coarse map, put into a finer one, are those of the same map.
TEST(BounceGather, FinerMapsAreTheSameMap) {
    constexpr std::uint32_t m = 8, n = 32;
    std::vector<float> coarse(6 * m * m), fine(6 * n * n), expected(6 * n * n);
    for (std::size_t k = 0; k < coarse.size(); ++k) {
        coarse[k] = std::sin(static_cast<float>(k));
    }
    for (std::size_t face = 0; face < 6; ++face) {
        for (std::size_t i = 0; i < n * n; ++i) {
            expected[face * n * n + i] = coarse[(face * m + i / n * m / n) * m + i % n * m / n];
        }
    }
    formats::haar_forward_cube(std::span<float>(expected), n);
    formats::haar_forward_cube(std::span<float>(coarse), m);
    add_to_finer(coarse, m, fine, n, 1);
    for (std::size_t k = 0; k < fine.size(); ++k) {
        EXPECT_NEAR(fine[k], expected[k], 1e-4);
    }
}

constexpr std::size_t kRowParts = 12;
using Parts = std::array<double, kRowParts>;

// What a point of a wall sends out: waves through space, twelve of them, about `cycles` across the
// room.
struct Waves {
    double cycles = 1;

    Parts at(glm::vec3 x) const {
        Parts parts{};
        for (std::uint32_t k = 0; k < kRowParts; ++k) {
            const auto u = random_uniform(3, RandomStage::bounce_rays, k);
            const glm::dvec3 wave{u[0] - 0.5, u[1] - 0.5, u[2] - 0.5};
            parts[k] =
                1 + std::sin(2 * std::numbers::pi *
                             (u[3] + cycles * glm::dot(wave, glm::dvec3(x)) / glm::length(wave)));
        }
        return parts;
    }
};

struct Room {
    formats::Scene scene = tests::make_scene({tests::make_cube(1, true)});
    RayScene rays = RayScene::build(scene, 1).value();
    std::vector<Scatterer> scatterers;
    std::vector<Receiver> receivers;

    // Scatterers at random places of the walls; receivers on the floor.
    explicit Room(std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto u = random_uniform(7, RandomStage::surface_probes, i);
            Scatterer s;
            const auto axis = static_cast<glm::length_t>(i % 3);
            s.normal[axis] = i % 6 < 3 ? 1.0f : -1.0f;
            s.position[axis] = -s.normal[axis];
            s.position[(axis + 1) % 3] = 2 * u[0] - 1;
            s.position[(axis + 2) % 3] = 2 * u[1] - 1;
            scatterers.push_back(s);
        }
        for (std::uint32_t i = 0; i < 24; ++i) {
            const auto u = random_uniform(8, RandomStage::surface_probes, i);
            receivers.push_back({{1.8f * u[0] - 0.9f, -1 + 1e-5f, 1.8f * u[1] - 0.9f}, {0, 1, 0}});
        }
    }
};

struct Errors {
    double exact_vectors = 0, nearest = 0, clusters = 0;  // RMS, relative
};

// Against a final gather of very many rays that read what the wave has at their end. The three have
// the same rays.
Errors compare(const Room& room, const Waves& waves, std::uint32_t count) {
    BounceTree tree(room.scatterers, 1, kRowParts);
    std::vector<float> rows;
    for (const Scatterer& s : room.scatterers) {
        for (const double part : waves.at(s.position)) {
            rows.push_back(static_cast<float>(part));
        }
    }
    tree.set_rows({rows, kRowParts});
    const auto exact = [&](const Receiver& at, const BounceGrid& grid) {
        Parts sum{};
        trace_bounces(room.rays, at, grid, 1, [&](const BounceHit& hit) {
            const Parts there = waves.at(hit.origin + hit.hits.distance[hit.lane] * hit.direction);
            for (std::size_t k = 0; k < kRowParts; ++k) {
                sum[k] += there[k] / grid.count();
            }
        });
        return sum;
    };
    const BounceGrid grid = make_bounce_grid(count), fine = make_bounce_grid(9216);
    Errors squares;
    double norm = 0;
    for (const Receiver& at : room.receivers) {
        const Parts truth = exact(at, fine), same_rays = exact(at, grid);
        const auto clustered = [&](LookUp look_up) {
            std::vector<NodeWeight> weights;
            weigh_bounces({room.scene, room.rays}, tree, at, grid, 1, weights, look_up);
            std::vector<float> row(kRowParts);
            add_node_rows(tree, weights, row);
            return row;
        };
        const std::vector<float> nearest = clustered(LookUp::nearest);
        const std::vector<float> clusters = clustered(LookUp::kernel);
        for (std::size_t k = 0; k < kRowParts; ++k) {
            squares.exact_vectors += std::pow(same_rays[k] - truth[k], 2);
            squares.nearest += std::pow(nearest[k] - truth[k], 2);
            squares.clusters += std::pow(clusters[k] - truth[k], 2);
            norm += truth[k] * truth[k];
        }
    }
    return {std::sqrt(squares.exact_vectors / norm), std::sqrt(squares.nearest / norm),
            std::sqrt(squares.clusters / norm)};
}

// Half a wave across the room is no detail, so that only noise can be saved; the others are waves
// as short as footprints, and shorter. At production's rays the difference from exact vectors at
// very many rays is below 1 % where light is smooth.
TEST(FinalGather, FootprintsBeatNearestSamplesWhereLightIsSmoothAndWhereItIsDetailed) {
    const Room room(4096);
    for (const std::uint32_t count : {16u, 64u, 256u}) {
        for (const double cycles : {0.5, 4.0, 10.0}) {
            const bool is_smooth = cycles < 1;
            if (count == 16 && !is_smooth) continue;
            SCOPED_TRACE(testing::Message() << count << " rays, " << cycles << " cycles");
            const Errors e = compare(room, {cycles}, count);
            EXPECT_GT(e.nearest, 1.5 * e.clusters);
            EXPECT_GT(e.exact_vectors, (is_smooth ? 1.4 : 1.2) * e.clusters);
            if (count == 256 && is_smooth) {
                EXPECT_LT(e.clusters, 0.01);
            }
        }
    }
}

}  // namespace

}  // namespace opaline::bake
