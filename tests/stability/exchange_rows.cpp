#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "bake/exchange/lamps/glow_light.h"
#include "bake/exchange/series_end.h"
#include "runtime/clouds/radiosity.h"
#include "tests/stability/stability_row.h"

// Light that surfaces send to each other.

namespace opaline::tests {
namespace {

using std::numbers::pi;

// All light of closed rooms that reflect `albedo` in each band, after so many bounces.
std::array<double, 2> after(int bounces, std::array<double, 2> albedo) {
    std::array<double, 2> sum{};
    for (std::size_t b = 0; b < 2; ++b) {
        for (int i = 0; i <= bounces; ++i) {
            sum[b] += std::pow(albedo[b], i);
        }
    }
    return sum;
}

// With the rest of the series in band `band`.
double all_light(int bounces, std::array<double, 2> albedo, std::size_t band) {
    bake::SeriesEnd end;
    for (int i = 0; i <= bounces; ++i) {
        end.add(after(i, albedo));
    }
    const double last = after(bounces, albedo)[band] - after(bounces - 1, albedo)[band];
    return after(bounces, albedo)[band] + end.rest(band) * last;
}

// One ratio for all bands.
double textbook_light(int bounces, std::array<double, 2> albedo, std::size_t band) {
    const auto last = [&](int i, std::size_t b) { return std::pow(albedo[b], i); };
    const double q =
        (last(bounces, 0) + last(bounces, 1)) / (last(bounces - 1, 0) + last(bounces - 1, 1));
    return after(bounces, albedo)[band] + q / (1 - q) * last(bounces, band);
}

double textbook_ratio(double last, double before) {
    return last / before;
}

// Irradiance of even ground under an even base.
double ground_light(float albedo) {
    const runtime::RadiosityCell cell{{1, 1, 1}, {0, 0, 0}, {albedo, 0, 0}, {albedo, 0, 0}};
    const runtime::PlaneGrid grid{4, 4, 25, 25, 100, true};
    return static_cast<double>(
        runtime::solve_radiosity(grid, std::vector(16, cell), cell).ground.front().r);
}

double textbook_cone(double radius, double distance) {
    const double sine = radius / distance;
    return 1 / (2 * pi * (1 - std::sqrt(1 - sine * sine)));
}

}  // namespace

StabilityField exchange_rows() {
    const glm::dvec3 up(0, 0, 1);
    const bake::BallDirections far({{0, 0, 1e9}, 1}, glm::dvec3(0), up);
    bake::SeriesEnd dark;
    for (int i = 0; i < 3; ++i) {
        dark.add(std::array{1.0});
    }
    return {
        "Exchange in cavities",
        {
            {"closed room", "all light; albedo .9, 8 bounces", "the bounces alone",
             after(8, {0.9, 0})[0], all_light(8, {0.9, 0}, 0), "10", 1e-12, 0.3},
            {"closed room", "all light; albedo .998, 8 bounces", "the bounces alone",
             after(8, {0.998, 0})[0], all_light(8, {0.998, 0}, 0), "1 / (1 - 0.998)", 1e-9, 0.9},
            {"bands of different albedo", "all light of the darker; .99 and .5, 4 bounces",
             "one ratio for all bands", textbook_light(4, {0.99, 0.5}, 1),
             all_light(4, {0.99, 0.5}, 1), "2", 1e-12, 0.3},
            {"room without another bounce", "ratio of bounces; albedo 0", "B_n / B_(n−1)",
             textbook_ratio(0, 0), dark.ratio(0), "0", 0, 1},
            {"snow, ρ R̄ → 1", "ground under a base, both .99, floats", "16 passes",
             (1 - std::pow(0.9801, 16)) / (1 - 0.9801), ground_light(0.99f),
             "1 / (1 - single(0.99) ** 2)", 1e-4, 0.5},
            {"lamp far away", "density of directions; radius 1, distance 1e9", "1 − √(1 − sin²)",
             textbook_cone(1, 1e9), far.pdf(up), "1 / (2 * pi * (1 - sqrt(1 - mpf(1e-9) ** 2)))",
             1e-14, 1},
        }};
}

}  // namespace opaline::tests
