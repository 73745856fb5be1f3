// Light between ground and clouds: the sum of Gaussians that the runtime convolves with, against
// the weights of MIP levels of [Bouthors2006] and the sum over all pairs of points. Prints the
// table of RESULTS.md, "Radiosity", as markdown; half a minute.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "runtime/clouds/mip_pyramid.h"
#include "runtime/clouds/plane_gather.h"
#include "runtime/clouds/radiosity.h"
#include "tests/bench/bench.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

constexpr float kHeight = 1000;  // of the base [m]
using Cells = std::vector<Rgb>;
using Gather = std::function<Cells(const PlaneGrid&, const Cells&)>;

/// Weights of bilinear samples of MIP levels, for cells as long as the base is high.
struct LevelWeight {
    float level, weight;
};
using Scheme = std::vector<LevelWeight>;
const Scheme kPrinted = {{0, 0.4f}, {1, 0.38667f}, {3, 0.21333f}};
const Scheme kFitted = {{0, 0.24f}, {1, 0.473f}, {2, 0.203f}, {3, 0.063f}, {4, 0.021f}};

Cells gather_levels(const PlaneGrid& grid, const Cells& radiosity, const Scheme& scheme) {
    const MipPyramid<Rgb> pyramid =
        make_pyramid(grid.columns, grid.rows, radiosity, MipBorder::repeat);
    // Of a level whose texels are as long as the base is high, whatever the grid.
    const float first = std::log2(grid.distance / grid.cell_x);
    Cells seen;
    seen.reserve(radiosity.size());
    for (std::uint32_t z = 0; z < grid.rows; ++z) {
        for (std::uint32_t x = 0; x < grid.columns; ++x) {
            Rgb sum;
            for (const LevelWeight& w : scheme) {
                sum = sum + w.weight * sample_pyramid(pyramid, (x + 0.5) / grid.columns,
                                                      (z + 0.5) / grid.rows, first + w.level);
            }
            seen.push_back(sum);
        }
    }
    return seen;
}

Cells gather_gaussians(const PlaneGrid& grid, const Cells& radiosity) {
    return gather(make_gather_plan(grid), radiosity, {}, 1);
}

/// K(q) of plane_gather.h, mean over cells by 4 x 4 midpoints, summed over all cells and over their
/// periods out to 40 heights; what is farther is even.
class AllPairs {
  public:
    explicit AllPairs(const PlaneGrid& grid)
        : grid_(grid), weight_(std::size_t{grid.columns} * grid.rows, 0.0) {
        constexpr int kPoints = 4, kFar = 40;
        const double h = static_cast<double>(grid.distance);
        const double side = static_cast<double>(grid.cell_x), area = side * side;
        const int far = static_cast<int>(std::ceil(kFar * h / side));
        double sum = 0;
        for (int z = -far; z <= far; ++z) {
            for (int x = -far; x <= far; ++x) {
                double k = 0;
                for (int p = 0; p < kPoints * kPoints; ++p) {
                    const double dx = side * (x + (p % kPoints + 0.5) / kPoints - 0.5);
                    const int row = p / kPoints;
                    const double dz = side * (z + (row + 0.5) / kPoints - 0.5);
                    const double s = h * h + dx * dx + dz * dz;
                    k += h * h / (std::numbers::pi * s * s) * area / (kPoints * kPoints);
                }
                weight_[wrap(z, grid.rows) * grid.columns + wrap(x, grid.columns)] += k;
                sum += k;
            }
        }
        for (double& weight : weight_) {
            weight += (1 - sum) / static_cast<double>(weight_.size());
        }
    }
    Cells operator()(const Cells& radiosity) const {
        Cells seen;
        seen.reserve(radiosity.size());
        for (std::uint32_t z = 0; z < grid_.rows; ++z) {
            for (std::uint32_t x = 0; x < grid_.columns; ++x) {
                seen.push_back(sum_over(radiosity, x, z));
            }
        }
        return seen;
    }

  private:
    static std::size_t wrap(int at, std::uint32_t period) {
        const int p = static_cast<int>(period);
        return static_cast<std::size_t>((at % p + p) % p);
    }
    Rgb sum_over(const Cells& radiosity, std::uint32_t x, std::uint32_t z) const {
        std::array<double, 3> sum{};
        for (std::uint32_t j = 0; j < grid_.rows; ++j) {
            const std::size_t row = (j + grid_.rows - z) % grid_.rows * std::size_t{grid_.columns};
            for (std::uint32_t i = 0; i < grid_.columns; ++i) {
                const double w = weight_[row + (i + grid_.columns - x) % grid_.columns];
                const Rgb& from = radiosity[std::size_t{j} * grid_.columns + i];
                sum[0] += w * static_cast<double>(from.r);
                sum[1] += w * static_cast<double>(from.g);
                sum[2] += w * static_cast<double>(from.b);
            }
        }
        return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
    }

    PlaneGrid grid_;
    std::vector<double> weight_;
};

/// Broken clouds over a coast of water and ice: half of the ground each, clouds in patches 1.6 km
/// wide on average.
std::vector<RadiosityCell> paint_coast(const PlaneGrid& grid) {
    std::vector<RadiosityCell> cells;
    const double width = static_cast<double>(grid.cell_x) * grid.columns;
    for (std::uint32_t z = 0; z < grid.rows; ++z) {
        for (std::uint32_t x = 0; x < grid.columns; ++x) {
            const double u = 2 * std::numbers::pi * (x + 0.5) / grid.columns;
            const double v = 2 * std::numbers::pi * (z + 0.5) / grid.rows;
            const double periods = width / 3200;
            const double wave = std::sin(std::round(periods) * u + std::sin(v)) +
                                std::sin(std::round(periods) * v + 2 * std::cos(u));
            const bool is_cloud = wave > 0, is_ice = x >= grid.columns / 2;
            RadiosityCell cell;
            cell.emission = is_cloud ? Rgb{1.2f, 1.2f, 1.2f} : Rgb{0.5f, 0.7f, 1};
            cell.direct = is_cloud ? Rgb{0.2f, 0.2f, 0.2f} : Rgb{2.2f, 2.1f, 2};
            cell.albedo = is_ice ? Rgb{0.85f, 0.86f, 0.88f} : Rgb{0.03f, 0.05f, 0.06f};
            cell.reflectance = is_cloud ? Rgb{0.6f, 0.6f, 0.6f} : Rgb{};
            cells.push_back(cell);
        }
    }
    return cells;
}

/// Light that the ground sends up and the base receives at last, by `passes` of a gather.
struct Exchange {
    Cells ground, base;
};
Exchange exchange_light(const PlaneGrid& grid, const std::vector<RadiosityCell>& cells,
                        const Gather& gather_by) {
    constexpr int kPasses = 20;
    Cells next;
    next.reserve(cells.size());
    for (const RadiosityCell& cell : cells) {
        next.push_back(cell.emission);
    }
    Exchange sum{gather_by(grid, next), Cells(cells.size())};
    for (std::size_t i = 0; i < cells.size(); ++i) {
        next[i] = cells[i].albedo * (cells[i].direct + sum.ground[i]);
    }
    for (int pass = 0; pass < kPasses; ++pass) {
        const Cells up = gather_by(grid, next);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            sum.base[i] = sum.base[i] + up[i];
            next[i] = cells[i].reflectance * up[i];
        }
        const Cells down = gather_by(grid, next);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            sum.ground[i] = sum.ground[i] + down[i];
            next[i] = cells[i].albedo * down[i];
        }
    }
    return sum;
}

struct Error {
    double rms = 0, largest = 0;  // relative to the mean
};
Error compare(const Cells& found, const Cells& truth) {
    double mean = 0, squares = 0, largest = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double d = static_cast<double>(found[i].g - truth[i].g);
        mean += static_cast<double>(truth[i].g);
        squares += d * d;
        largest = std::max(largest, std::abs(d));
    }
    const auto n = static_cast<double>(truth.size());
    mean /= n;
    return {std::sqrt(squares / n) / mean, largest / mean};
}

double least_milliseconds(const std::function<void()>& work) {
    double least = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 7; ++run) {
        const auto start = std::chrono::steady_clock::now();
        work();
        least = std::min(least, std::chrono::duration<double, std::milli>(
                                    std::chrono::steady_clock::now() - start)
                                    .count());
    }
    return least;
}

PlaneGrid make_grid(std::uint32_t cells) {
    return {cells, cells, kHeight / 2, kHeight / 2, kHeight, true};
}

struct Method {
    const char* name;
    Gather gather;
};

std::vector<Method> list_methods() {
    const auto levels = [](const Scheme& scheme) {
        return [&scheme](const PlaneGrid& grid, const Cells& cells) {
            return gather_levels(grid, cells, scheme);
        };
    };
    return {{"MIP levels, printed weights", levels(kPrinted)},
            {"MIP levels, 5 fitted weights", levels(kFitted)},
            {"14 Gaussians", gather_gaussians}};
}

void print_errors() {
    const PlaneGrid grid = make_grid(64);
    const std::vector<RadiosityCell> cells = paint_coast(grid);
    const AllPairs pairs(grid);
    const Exchange truth = exchange_light(
        grid, cells, [&](const PlaneGrid&, const Cells& from) { return pairs(from); });
    std::printf(
        "| method | on the ground | on the base | 128 x 128 cells |\n|---|---:|---:|---:|\n");
    const PlaneGrid large = make_grid(128);
    const Cells radiosity(std::size_t{large.columns} * large.rows, Rgb{1, 1, 1});
    for (const Method& method : list_methods()) {
        const Exchange found = exchange_light(grid, cells, method.gather);
        const Error ground = compare(found.ground, truth.ground);
        const Error base = compare(found.base, truth.base);
        const double time = least_milliseconds([&] { method.gather(large, radiosity); });
        std::printf("| %s | %.2f %% (%.1f %%) | %.2f %% (%.1f %%) | %.1f ms |\n", method.name,
                    100 * ground.rms, 100 * ground.largest, 100 * base.rms, 100 * base.largest,
                    time);
    }
}

}  // namespace
}  // namespace opaline::runtime

int opaline::tests::radiosity_table(int, char**) {
    opaline::runtime::print_errors();
    return 0;
}
