// Density between points of volumes and suns against integrals along each line in small steps.
#include "runtime/volumes/sun_columns.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/runtime/volumes/synthetic_volume.h"

namespace opaline::runtime {
namespace {

using formats::Vec3;
using test::TestVolume;

constexpr std::array<float, 12> kSheared{0.5f, 0.2f, 0, 3,    -0.1f, 0.7f,
                                         0.3f, -20,  0, 0.1f, 0.4f,  7};

// Waves with holes, of 7 x 6 x 5 bricks, which fade toward the faces of the table.
TestVolume waves(std::uint32_t spacing) {
    TestVolume volume;
    volume.first_brick = {-3, 2, -1};
    volume.extent = {7, 6, 5};
    volume.spacing = spacing;
    volume.to_world = kSheared;
    volume.density = [](float x, float y, float z) {
        const float wave = std::sin(0.17f * x + 1) * std::sin(0.13f * y) + std::sin(0.2f * z + 2);
        const auto fade = [](float at, float first, float last) {
            return std::min({1.0f, 0.125f * (at - first), 0.125f * (last - at)});
        };
        return std::max(0.0f, wave * fade(x, -24, 32) * fade(y, 16, 64) * fade(z, -8, 32));
    };
    return volume;
}

std::vector<Vec3> some_suns() {
    std::vector<Vec3> suns{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
    std::mt19937 generator(5);
    std::normal_distribution<float> normal;
    while (suns.size() < 12) {
        const Vec3 d{normal(generator), normal(generator), normal(generator)};
        suns.push_back((1 / length(d)) * d);
    }
    // Along an axis of voxels, and along the diagonal of them.
    for (const Vec3 d : {Vec3{0.5f, -0.1f, 0}, Vec3{0.7f, 0.9f, 0.5f}, Vec3{-0.3f, -0.8f, -0.5f}}) {
        suns.push_back((1 / length(d)) * d);
    }
    return suns;
}

Vec3 world_of_point(const SunColumns& columns, std::uint32_t brick, std::size_t point) {
    const formats::VolumeRecord& record = *columns.lattice.record;
    const std::size_t side = columns.boxes() + 1;
    const std::array<std::size_t, 3> place{point % side, point / side % side, point / side / side};
    const auto cell = columns.cell(brick);
    std::array<float, 3> index{};
    for (std::size_t a = 0; a < 3; ++a) {
        index[a] = 8 * static_cast<float>(record.first_brick[a] + cell[a]) +
                   static_cast<float>(8 * place[a]) / static_cast<float>(columns.boxes());
    }
    const auto& m = record.to_world;
    const auto row = [&](std::size_t r) {
        return m[r] * index[0] + m[r + 1] * index[1] + m[r + 2] * index[2] + m[r + 3];
    };
    return {row(0), row(4), row(8)};
}

// In steps of 1/20 voxel and less.
double integrate(const VolumeLattice& lattice, Vec3 from, Vec3 sun) {
    const auto p = index_of_point(lattice, from), d = index_of_direction(lattice, sun);
    const double step = 0.05 / std::max({std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
    double sum = 0;
    for (int i = 0; i < 4000; ++i) {
        std::array<std::int32_t, 3> cell{};
        std::array<float, 3> at{};
        for (std::size_t a = 0; a < 3; ++a) {
            const double bricks =
                (p[a] + (i + 0.5) * step * d[a]) / 8 - lattice.record->first_brick[a];
            cell[a] = static_cast<std::int32_t>(std::floor(bricks));
            at[a] = static_cast<float>(8 * (bricks - cell[a]));
        }
        if (lattice.brick(cell) == formats::kNoBrick) continue;
        sum += step * static_cast<double>(density_at(lattice, brick_block(lattice, cell), at));
    }
    return sum;
}

struct PlacedWaves {
    formats::Volumes volumes = test::make_volumes(test::kSize);
    formats::VolumesView view;
    std::vector<SunColumns> placed;

    explicit PlacedWaves(const std::vector<TestVolume>& parts) {
        for (const TestVolume& part : parts) {
            test::add_volume(volumes, part);
        }
        view = volumes.view();
        placed = place_volumes(view);
    }
};

TEST(SunColumns, VolumesKnowTheirNumberInTheAssetWhereOneBeforeThemIsEmpty) {
    formats::Volumes volumes = test::make_volumes(test::kSize);
    test::add_volume(volumes, waves(4));
    test::add_volume(volumes, waves(4));
    volumes.records[0].brick_count = 0;
    const std::vector<SunColumns> placed = place_volumes(volumes.view());
    ASSERT_EQ(placed.size(), 1u);
    EXPECT_EQ(placed[0].volume, 1u);
    EXPECT_EQ(placed[0].lattice.record, &volumes.view().records[1]);
}

TEST(SunColumns, AreIntegralsOfTheDensityTowardEachSun) {
    const std::vector<Vec3> suns = some_suns();
    for (const std::uint32_t spacing : {1u, 2u, 4u, 8u}) {
        PlacedWaves waves_of({waves(spacing)});
        find_sun_columns(waves_of.placed, suns, 2);
        const SunColumns& columns = waves_of.placed[0];
        ASSERT_LT(columns.cell_of_brick.size(), 7u * 6 * 5);
        ASSERT_GT(columns.cell_of_brick.size(), 80u);
        std::mt19937 generator(7);
        double error = 0, whole = 0;
        for (std::size_t s = 0; s < suns.size(); ++s) {
            for (int i = 0; i < 60; ++i) {
                const auto brick =
                    static_cast<std::uint32_t>(generator() % columns.cell_of_brick.size());
                const std::size_t point = generator() % columns.points();
                const Vec3 from = world_of_point(columns, brick, point);
                const double truth = integrate(columns.lattice, from, suns[s]);
                const double found =
                    static_cast<double>(columns.column[s][brick * columns.points() + point]);
                EXPECT_NEAR(found, truth, 0.35) << spacing << ", " << s;  // of up to some 15 m
                error += (found - truth) * (found - truth);
                whole += truth * truth;
            }
        }
        EXPECT_LT(std::sqrt(error / whole), spacing == 8 ? 0.03 : 0.015) << spacing;
    }
}

TEST(SunColumns, FromAnywhereAreThoseOfTheirPointsAndOfPlacesBeforeAndBehindThem) {
    const std::vector<Vec3> suns = some_suns();
    PlacedWaves waves_of({waves(4)});
    find_sun_columns(waves_of.placed, suns, 1);
    const SunColumns& columns = waves_of.placed[0];
    for (std::size_t s = 0; s < suns.size(); ++s) {
        for (std::uint32_t brick = 0; brick < columns.cell_of_brick.size(); brick += 7) {
            const Vec3 at = world_of_point(columns, brick, 62);  // in its middle
            EXPECT_NEAR(column_from(columns, s, suns[s], at),
                        columns.column[s][brick * columns.points() + 62], 1e-3);
            EXPECT_EQ(column_from(columns, s, suns[s], at + 500 * suns[s]), 0);
            const Vec3 behind = at - 20 * suns[s];
            const double truth = integrate(columns.lattice, behind, suns[s]);
            const auto found = static_cast<double>(column_from(columns, s, suns[s], behind));
            EXPECT_NEAR(found, truth, 0.4 + 0.05 * truth);  // of up to some 20 m
        }
    }
}

// Else relighting takes as long as the square of the number of volumes.
TEST(SunShadows, OnlyVolumesTowardTheSunMayShade) {
    std::vector<TestVolume> row;
    for (std::size_t i = 0; i < 6; ++i) {
        TestVolume volume;
        volume.to_world[3] = 20 * static_cast<float>(i);
        row.push_back(volume);
    }
    PlacedWaves placed(row);
    const float d = 1 / std::sqrt(2.0f);
    const std::vector<Vec3> suns{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {d, d, 0}};
    const auto shades = find_shades(placed.placed, 2, suns);
    ASSERT_EQ(shades.size(), 4u);
    EXPECT_EQ(shades[0], (std::vector<std::size_t>{3, 4, 5}));
    EXPECT_EQ(shades[1], (std::vector<std::size_t>{0, 1}));
    EXPECT_TRUE(shades[2].empty());
    EXPECT_TRUE(shades[3].empty());
}

// Every volume that a point's light meets is among them.
TEST(SunShadows, OfLeaningVolumesNoneIsMissed) {
    std::vector<TestVolume> parts;
    std::mt19937 generator(11);
    std::uniform_real_distribution<float> even(-1, 1);
    for (int i = 0; i < 8; ++i) {
        TestVolume volume;
        volume.extent = {2, 1, 2};
        for (std::size_t r = 0; r < 3; ++r) {
            for (std::size_t c = 0; c < 3; ++c) {
                volume.to_world[4 * r + c] = even(generator) + (r == c ? 1.5f : 0);
            }
            volume.to_world[4 * r + 3] = 40 * even(generator);
        }
        parts.push_back(volume);
    }
    PlacedWaves placed(parts);
    const std::vector<Vec3> suns = some_suns();
    find_sun_columns(placed.placed, suns, 1);
    int met = 0, left_out = 0;
    for (std::size_t own = 0; own < 8; ++own) {
        const auto shades = find_shades(placed.placed, own, suns);
        for (std::size_t s = 0; s < suns.size(); ++s) {
            for (std::size_t other = 0; other < 8; ++other) {
                if (other == own || std::ranges::count(shades[s], other) > 0) continue;
                ++left_out;
                for (std::uint32_t brick = 0; brick < 4; ++brick) {
                    for (std::size_t point = 0; point < placed.placed[own].points(); ++point) {
                        EXPECT_EQ(column_from(placed.placed[other], s, suns[s],
                                              world_of_point(placed.placed[own], brick, point)),
                                  0);
                    }
                }
            }
            met += static_cast<int>(shades[s].size());
        }
    }
    EXPECT_GT(met, 20);
    EXPECT_GT(left_out, 200);
}

}  // namespace
}  // namespace opaline::runtime
