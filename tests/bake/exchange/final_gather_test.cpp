#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/scatterers.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

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
