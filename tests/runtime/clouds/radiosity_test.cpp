#include "runtime/clouds/radiosity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::runtime {
namespace {

using formats::Rgb;

RadiosityCell even_cell(float albedo, float reflectance) {
    return {
        {2, 1, 0.5f}, {3, 0, 1}, {albedo, albedo, 0.5f * albedo}, {reflectance, 0.3f, reflectance}};
}

std::vector<RadiosityCell> repeat(const PlaneGrid& grid, const RadiosityCell& cell) {
    return std::vector<RadiosityCell>(std::size_t{grid.columns} * grid.rows, cell);
}

// E on the ground of even planes: (S^d + S_C) / (1 - rho R), of which S^d is direct; the base gets
// rho E. The last one is snow under a thick cloud.
TEST(Radiosity, EvenPlanesHaveTheClosedForm) {
    for (const bool wraps : {true, false}) {
        const PlaneGrid grid{20, 12, 25, 30, 100, wraps};
        for (const float product : {0.0f, 0.2f, 0.6f, 0.9f, 0.98f}) {
            const RadiosityCell cell = even_cell(product, product);
            const Radiosity result = solve_radiosity(grid, repeat(grid, cell), cell);
            const auto check = [&](auto band) {
                const double rho = static_cast<double>(cell.albedo.*band);
                const double all = static_cast<double>(cell.emission.*band + cell.direct.*band) /
                                   (1 - rho * static_cast<double>(cell.reflectance.*band));
                const double indirect = all - static_cast<double>(cell.direct.*band);
                const auto near = [&](Rgb value, double exact) {
                    EXPECT_NEAR(static_cast<double>(value.*band), exact, 2e-4 * exact + 1e-6)
                        << product;
                };
                for (std::size_t i = 0; i < result.ground.size(); ++i) {
                    near(result.ground[i], indirect);
                    near(result.base[i], rho * all);
                }
                near(result.outside_ground, indirect);
                near(result.outside_base, rho * all);
            };
            check(&Rgb::r);
            check(&Rgb::g);
            check(&Rgb::b);
        }
    }
}

// K(q) of plane_gather.h, summed over all pairs of cells at their centres: cells are a fifth of h.
TEST(Radiosity, BrokenCloudsAgreeWithSumsOverAllPairs) {
    const PlaneGrid grid{40, 30, 20, 20, 100, false};
    std::vector<RadiosityCell> cells;
    for (std::uint32_t z = 0; z < grid.rows; ++z) {
        for (std::uint32_t x = 0; x < grid.columns; ++x) {
            const bool is_cloud = (x / 8 + z / 10) % 2 == 0;
            cells.push_back({is_cloud ? Rgb{2, 1, 1} : Rgb{0.5f, 1, 2},
                             is_cloud ? Rgb{} : Rgb{4, 3, 2},
                             x < 20 ? Rgb{0.8f, 0.5f, 0.1f} : Rgb{0.2f, 0.5f, 0.9f},
                             is_cloud ? Rgb{0.7f, 0.7f, 0.7f} : Rgb{}});
        }
    }
    const RadiosityCell nothing{};
    const auto sum_pairs = [&](const std::vector<double>& sent) {
        std::vector<double> seen(sent.size());
        for (std::size_t i = 0; i < seen.size(); ++i) {
            for (std::size_t j = 0; j < sent.size(); ++j) {
                const double dx = 20 * (static_cast<double>(i % 40) - static_cast<double>(j % 40));
                const double dz = 20 * (static_cast<double>(i / 40) - static_cast<double>(j / 40));
                const double sum = 1e4 + dx * dx + dz * dz;
                seen[i] += sent[j] * 400 * 1e4 / (std::numbers::pi * sum * sum);
            }
        }
        return seen;
    };
    const std::size_t count = cells.size();
    std::vector<double> sent(count), ground(count), base(count);
    for (std::size_t i = 0; i < count; ++i) {
        sent[i] = static_cast<double>(cells[i].emission.r);
    }
    for (int pass = 0; pass < 12; ++pass) {
        const std::vector<double> down = sum_pairs(sent);
        for (std::size_t i = 0; i < count; ++i) {
            ground[i] += down[i];
            sent[i] = static_cast<double>(cells[i].albedo.r) *
                      (down[i] + (pass == 0 ? static_cast<double>(cells[i].direct.r) : 0));
        }
        const std::vector<double> up = sum_pairs(sent);
        for (std::size_t i = 0; i < count; ++i) {
            base[i] += up[i];
            sent[i] = static_cast<double>(cells[i].reflectance.r) * up[i];
        }
    }
    const Radiosity result = solve_radiosity(grid, cells, nothing);
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_NEAR(static_cast<double>(result.ground[i].r), ground[i], 1e-2);
        EXPECT_NEAR(static_cast<double>(result.base[i].r), base[i], 1e-2);
    }
}

double total(const std::vector<Rgb>& plane) {
    double sum = 0;
    for (const Rgb& value : plane) {
        sum += static_cast<double>(value.r);
    }
    return sum;
}

// Each pass replaces an estimate of the rest by what is there.
TEST(Radiosity, EnergyThatPassesAddNeverGrows) {
    const PlaneGrid grid{33, 20, 25, 25, 90, true};
    std::vector<RadiosityCell> cells = repeat(grid, even_cell(1, 0.95f));
    for (std::size_t i = 0; i < cells.size(); i += 3) {
        cells[i] = even_cell(0.9f, 1);
    }
    double before = 0, added_before = 1e30;
    for (std::uint32_t passes = 1; passes < 12; ++passes) {
        const double now = total(solve_radiosity(grid, cells, {}, {.max_passes = passes}).ground);
        if (passes > 2) {
            EXPECT_LE(std::abs(now - before), added_before * 1.001 + 1e-3 * now);
        }
        added_before = std::abs(now - before);
        before = now;
        EXPECT_TRUE(std::isfinite(now));
    }
    // What the ground absorbs cannot exceed what comes in, and nothing else absorbs here.
    std::vector<RadiosityCell> closed =
        repeat(grid, {{1, 1, 1}, {}, {0.5f, 0.5f, 0.5f}, {1, 1, 1}});
    for (std::size_t i = 0; i < closed.size(); i += 2) {
        closed[i].emission = {};
    }
    double sent = 0;
    for (const RadiosityCell& cell : closed) {
        sent += static_cast<double>(cell.emission.r);
    }
    EXPECT_NEAR(0.5 * total(solve_radiosity(grid, closed, {}).ground) / sent, 1, 1e-4);
}

TEST(Radiosity, BlackGroundNeedsNoPassAndSnowIsBounded) {
    const PlaneGrid grid{16, 16, 25, 25, 100, true};
    const Radiosity black = solve_radiosity(grid, repeat(grid, even_cell(0, 0.9f)), {});
    EXPECT_EQ(black.passes, 0u);
    EXPECT_TRUE(std::ranges::all_of(black.base, [](Rgb c) { return c == Rgb{}; }));
    EXPECT_LE(solve_radiosity(grid, repeat(grid, even_cell(0.05f, 0.9f)), {}).passes, 3u);
    const Radiosity snow = solve_radiosity(grid, repeat(grid, even_cell(1, 1)), {});
    EXPECT_EQ(snow.passes, RadiosityOptions{}.max_passes);
    EXPECT_TRUE(
        std::ranges::all_of(snow.ground, [](Rgb c) { return std::isfinite(c.r) && c.r > 0; }));
}

}  // namespace
}  // namespace opaline::runtime
