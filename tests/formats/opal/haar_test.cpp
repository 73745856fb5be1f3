#include "formats/opal/haar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "formats/opal/cubemap.h"
#include "tests/support/expression.h"
#include "tests/support/reference_table.h"

namespace opaline::formats {
namespace {

std::vector<double> random_values(std::size_t count, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    std::vector<double> values(count);
    for (double& value : values) {
        value = normal(generator);
    }
    return values;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += a[i] * b[i];
    }
    return sum;
}

TEST(Haar, DotProductsSurviveTheTransform) {  // Parseval
    for (const std::uint32_t n : {8u, 32u, 64u}) {
        std::vector<double> a = random_values(cubemap_texels(n), 1);
        std::vector<double> b = random_values(cubemap_texels(n), 2);
        const double before = dot(a, b), scale = std::sqrt(dot(a, a) * dot(b, b));
        haar_forward_cube(std::span(a), n);
        haar_forward_cube(std::span(b), n);
        EXPECT_NEAR(dot(a, b) / scale, before / scale, 1e-14);
    }
}

TEST(Haar, InverseRestoresTheMap) {
    const std::vector<double> original = random_values(32 * 32, 3);
    std::vector<double> face = original, scratch(face.size());
    haar_forward(face, 32, scratch);
    EXPECT_GT(std::abs(face[5] - original[5]), 1e-6);
    haar_inverse(face, 32, scratch);
    for (std::size_t i = 0; i < face.size(); ++i) {
        ASSERT_NEAR(face[i], original[i], 1e-13);
    }
}

TEST(Haar, SupportIsTheSquareOnWhichADetailDiffersFromZero) {
    const std::uint32_t n = 16;
    std::vector<double> scratch(n * n);
    for (std::uint32_t k = 0; k < n * n; ++k) {
        std::vector<double> face(n * n, 0.0);
        face[k] = 1;
        haar_inverse(face, n, scratch);
        std::uint32_t touched = 0;
        for (const double value : face) {
            touched += value != 0 ? 1 : 0;
        }
        const std::uint32_t side = haar_support(n, k / n, k % n);
        ASSERT_EQ(touched, side * side) << k;
    }
}

TEST(Haar, CoefficientsMatchTheReference) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", "haar2d");
    for (const auto& row : rows) {
        const auto n = static_cast<std::uint32_t>(row.number("n"));
        std::vector<double> face(n * n), scratch(n * n);
        for (std::uint32_t i = 0; i < n; ++i) {
            for (std::uint32_t j = 0; j < n; ++j) {
                face[i * n + j] =
                    tests::Expression(row.input.at("f"), {{"i", i}, {"j", j}, {"n", n}}).evaluate();
            }
        }
        haar_forward(face, n, scratch);
        const auto at = static_cast<std::size_t>(row.number("row") * n + row.number("col"));
        EXPECT_NEAR(face[at], row.expected, std::max(row.tolerance(), 1e-12)) << row.name();
    }
}

}  // namespace
}  // namespace opaline::formats
