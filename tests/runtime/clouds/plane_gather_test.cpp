#include "runtime/clouds/plane_gather.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace opaline::runtime {
namespace {

using formats::Rgb;

// K(q), the form factor of parallel planes, for q^2 = x^2 + z^2.
double kernel(double x, double z, double h) {
    const double sum = h * h + x * x + z * z;
    return h * h / (std::numbers::pi * sum * sum);
}

// Midpoint rule over a cell around (x, z), finer where the kernel is narrow.
double kernel_of_cell(double x, double z, const PlaneGrid& grid) {
    const double a = static_cast<double>(grid.cell_x), b = static_cast<double>(grid.cell_z);
    const double h = static_cast<double>(grid.distance);
    const auto parts = [&](double width) {
        return std::max(4, static_cast<int>(std::ceil(6 * width / h)));
    };
    const int m = parts(a), n = parts(b);
    double sum = 0;
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < m; ++i) {
            sum += kernel(x + a * ((i + 0.5) / m - 0.5), z + b * ((j + 0.5) / n - 0.5), h);
        }
    }
    return sum * a * b / (m * n);
}

std::vector<Rgb> paint(const PlaneGrid& grid, const std::function<float(double, double)>& value) {
    std::vector<Rgb> cells;
    for (std::uint32_t z = 0; z < grid.rows; ++z) {
        for (std::uint32_t x = 0; x < grid.columns; ++x) {
            const float v = value((x + 0.5) * static_cast<double>(grid.cell_x),
                                  (z + 0.5) * static_cast<double>(grid.cell_z));
            cells.push_back({v, 0.5f * v, 0.25f});
        }
    }
    return cells;
}

// Light of one cell in the middle: the irradiance is the kernel itself, cell by cell.
double kernel_error(const PlaneGrid& grid) {
    std::vector<Rgb> cells(std::size_t{grid.columns} * grid.rows);
    const std::uint32_t x0 = grid.columns / 2, z0 = grid.rows / 2;
    cells[std::size_t{z0} * grid.columns + x0] = {1, 0, 0};
    const std::vector<Rgb> seen = gather(make_gather_plan(grid), cells, {}, 1);
    double error = 0, inside = 0;
    for (std::uint32_t z = 0; z < grid.rows; ++z) {
        for (std::uint32_t x = 0; x < grid.columns; ++x) {
            const double exact = kernel_of_cell(
                (static_cast<double>(x) - x0) * static_cast<double>(grid.cell_x),
                (static_cast<double>(z) - z0) * static_cast<double>(grid.cell_z), grid);
            inside += exact;
            error +=
                std::abs(static_cast<double>(seen[std::size_t{z} * grid.columns + x].r) - exact);
        }
    }
    EXPECT_GT(inside, 0.9);
    return error;
}

TEST(PlaneGather, WeightsAreTheKernelForCellsOfAnyShape) {
    for (const auto& [cell_x, cell_z] : {std::pair{25.0f, 25.0f},
                                         {10.0f, 10.0f},
                                         {30.0f, 12.0f},
                                         {60.0f, 60.0f},
                                         {100.0f, 100.0f},
                                         {400.0f, 300.0f}}) {
        EXPECT_LT(kernel_error({151, 129, cell_x, cell_z, 100, false}), 8e-3) << cell_x;
    }
}

TEST(PlaneGather, PlanesMuchCloserThanACellSeeOnlyTheCellAcross) {
    const PlaneGrid grid{9, 7, 1e6f, 1e5f, 1, true};
    const auto cells =
        paint(grid, [](double x, double z) { return x > 4e6 && z > 2e5 ? 3.0f : 1.0f; });
    const std::vector<Rgb> seen = gather(make_gather_plan(grid), cells, {});
    for (std::size_t i = 0; i < cells.size(); ++i) {
        EXPECT_NEAR(seen[i].r, cells[i].r, 1e-3f);
    }
}

TEST(PlaneGather, PlanesMuchFartherThanTheGridSeeItsMeanOrTheOutside) {
    PlaneGrid grid{12, 9, 1, 2, 1e5f, true};
    const auto cells = paint(grid, [](double x, double) { return x < 6 ? 3.0f : 1.0f; });
    for (const Rgb& value : gather(make_gather_plan(grid), cells, {})) {
        EXPECT_NEAR(value.r, 2, 1e-4f);
    }
    grid.wraps = false;
    for (const Rgb& value : gather(make_gather_plan(grid), cells, {7, 7, 7})) {
        EXPECT_NEAR(value.r, 7, 1e-4f);
    }
}

// A half plane whose edge is d away has the share (1 - d / sqrt(h^2 + d^2)) / 2.
double share_behind(double d) {
    return (1 - d / std::hypot(100.0, d)) / 2;
}

TEST(PlaneGather, BeyondAnEdgeLiesTheOutside) {
    const PlaneGrid strip{400, 16, 25, 25, 100, false};
    const auto cells = paint(strip, [](double, double) { return 1.0f; });
    const std::vector<Rgb> seen = gather(make_gather_plan(strip), cells, {3, 0.5f, 0.25f});
    for (const std::uint32_t z : {0u, 1u, 4u, 8u, 15u}) {
        const double d = (z + 0.5) * 25;
        const double outside = share_behind(d) + share_behind(16 * 25 - d);
        EXPECT_NEAR(static_cast<double>(seen[z * 400 + 200].r), 1 + 2 * outside, 5e-3);
        EXPECT_NEAR(seen[z * 400 + 200].g, 0.5f, 1e-6f);
        EXPECT_NEAR(seen[z * 400 + 200].b, 0.25f, 1e-6f);
    }
}

TEST(PlaneGather, EvenRadiosityComesBackAndEnergyIsKept) {
    for (const auto& [columns, rows] : {std::pair{64u, 32u}, {37u, 51u}, {1u, 1u}, {3u, 200u}}) {
        const PlaneGrid grid{columns, rows, 30, 20, 70, true};
        const GatherPlan plan = make_gather_plan(grid);
        for (const Rgb& value :
             gather(plan, paint(grid, [](double, double) { return 1.0f; }), {})) {
            EXPECT_NEAR(value.r, 1, 1e-6f);
        }
        const auto cells = paint(grid, [](double x, double z) {
            return static_cast<float>(1 + std::sin(x / 50) * std::cos(z / 90));
        });
        double sent = 0, received = 0;
        const std::vector<Rgb> seen = gather(plan, cells, {});
        for (std::size_t i = 0; i < cells.size(); ++i) {
            sent += static_cast<double>(cells[i].r);
            received += static_cast<double>(seen[i].r);
        }
        EXPECT_NEAR(received / sent, 1, 1e-6);
    }
}

TEST(PlaneGather, AWrappingGridIsTheSamePeriodOverAndOver) {
    const auto stripes = [](double x, double z) {
        return std::fmod(x, 800) < 300 && std::fmod(z, 400) < 250 ? 1.0f : 0.0f;
    };
    const PlaneGrid period{32, 16, 25, 25, 100, true}, many{512, 512, 25, 25, 100, false};
    const std::vector<Rgb> wrapped = gather(make_gather_plan(period), paint(period, stripes), {});
    const std::vector<Rgb> laid = gather(make_gather_plan(many), paint(many, stripes), {});
    for (std::uint32_t z = 0; z < 16; ++z) {
        for (std::uint32_t x = 0; x < 32; ++x) {
            EXPECT_NEAR(wrapped[z * 32 + x].r, laid[(z + 256) * 512 + x + 256].r, 3e-3f);
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
