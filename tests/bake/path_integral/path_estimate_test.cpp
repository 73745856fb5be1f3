#include "bake/path_integral/path_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/scattering/gauss_legendre.h"
#include "bake/scattering/phase.h"
#include "tests/bake/path_integral/path_support.h"

namespace opaline::bake {
namespace {

using glm::dvec3;

constexpr double kPi = std::numbers::pi;
constexpr double kOnce[] = {1.0};

ZonalTable table_of(PathKernel kernel, double g) {
    return make_zonal_table(kernel, expand_henyey_greenstein(g, 400));
}

template <class Medium>
double estimate(const ZonalTable& table, const PathQuery& query, const Medium& medium,
                const MarchLimits& limits, std::span<const double> lengths = kOnce) {
    return estimate_scattered(table, query, medium, limits, lengths,
                              [&](dvec3 x) { return medium.visibility(x, query.light); });
}

double estimate_row(const tests::VolumeRow& row, PathKernel kernel, int steps) {
    const double size = row.number("size");
    const PathQuery query{tests::vector_of(row, "p"), tests::vector_of(row, "v"),
                          tests::vector_of(row, "l")};
    const ZonalTable table = table_of(kernel, row.number("g"));
    const double lengths[] = {row.number("arg")};
    if (row.cell.at("geometry") == "sphere") {
        return estimate(table, query,
                        tests::Ball{row.number("sigma_t"), size, row.number("albedo")},
                        {.box = tests::cube(size), .step = 2 * size / steps}, lengths);
    }
    EXPECT_EQ(row.cell.at("geometry"), "blob") << row.id();
    return estimate(table, query,
                    tests::Blob{row.number("sigma_t"), size, row.number("albedo"), 4 * size},
                    {.box = tests::cube(4 * size), .step = 8 * size / steps}, lengths);
}

TEST(PathEstimate, LightOfTwoScatteringsOrMoreIsThatOfTheTable) {
    for (const PathKernel kernel : {PathKernel::ray, PathKernel::source}) {
        OPALINE_VOLUME_ROWS(rows, kernel == PathKernel::ray ? "pi_L2plus" : "pi_J2plus");
        for (const auto& row : rows) {
            for (int n : {50, 100, 400, 1600, 6400})
                std::printf("%s %d %.3e\n", row.id().c_str(), n,
                            estimate_row(row, kernel, n) / row.value() - 1);
            EXPECT_NEAR(estimate_row(row, kernel, 400) / row.value(), 1, 5e-3) << row.id();
        }
    }
}

}  // namespace
}  // namespace opaline::bake
