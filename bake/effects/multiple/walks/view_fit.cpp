#include "bake/effects/multiple/walks/view_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSecond = 4;  // first harmonic of degree two

double legendre_2(double c) {
    return 1.5 * c * c - 0.5;
}

}  // namespace

ViewFit make_view_fit(double eta) {
    const auto mean_of = [eta](const auto& function) { return mean_over_views(eta, function); };
    ViewFit fit;
    fit.steepest = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
    fit.mean = mean_of([](double c, double) { return c; });
    fit.variance = mean_of([&](double c, double) { return (c - fit.mean) * (c - fit.mean); });
    const double square = mean_of([](double, double s2) { return s2; });
    fit.across = 0.5 * square;
    fit.level = mean_of([](double c, double) { return legendre_2(c); });
    fit.slope =
        mean_of([&](double c, double) { return (c - fit.mean) * legendre_2(c); }) / fit.variance;
    fit.bend = mean_of([&](double c, double) { return bend_of(fit, c) * bend_of(fit, c); });
    fit.middle = mean_of([](double c, double s2) { return c * s2; }) / square;
    fit.tilt =
        mean_of([&](double c, double s2) { return (c - fit.middle) * (c - fit.middle) * s2; });
    fit.around = mean_of([](double, double s2) { return s2 * s2; });
    return fit;
}

double bend_of(const ViewFit& fit, double cosine) {
    return legendre_2(cosine) - fit.level - fit.slope * (cosine - fit.mean);
}

glm::mat3 second_harmonic(std::uint32_t k) {
    constexpr double kScale = 1.0925484305920792;  // sqrt(15 / (4 pi))
    constexpr auto kHalf = static_cast<float>(0.5 * kScale);
    constexpr auto kZonal = static_cast<float>(0.5 * kScale * std::numbers::inv_sqrt3);
    glm::mat3 b(0);
    switch (k) {
        case 4:
            b[0][1] = b[1][0] = kHalf;
            break;
        case 5:
            b[1][2] = b[2][1] = kHalf;
            break;
        case 6:
            b[0][0] = b[1][1] = -kZonal;
            b[2][2] = 2 * kZonal;
            break;
        case 7:
            b[0][2] = b[2][0] = kHalf;
            break;
        default:
            b[0][0] = kHalf;
            b[1][1] = -kHalf;
    }
    return b;
}

ViewLobe eval_view_lobe(const ViewFit& fit, glm::vec3 normal, glm::vec3 seen, bool second) {
    const float cosine = glm::dot(normal, seen);
    const glm::vec3 t = seen - cosine * normal;
    const auto c = static_cast<double>(cosine);
    const auto along = static_cast<float>((c - fit.mean) / fit.variance);
    const glm::vec3 first = along * normal + t / static_cast<float>(fit.across);
    ViewLobe lobe{first.x, first.y, first.z};
    if (!second) return lobe;
    // The square of every B is 15 / (8 pi), so a quadratic form S has coefficients
    // (8 pi / 15) S : B.
    constexpr double kForm = 8 * std::numbers::pi / 15;
    const auto bend = static_cast<float>(1.5 * kForm * bend_of(fit, c) / fit.bend);
    const auto tilt = static_cast<float>(2 * kForm * (c - fit.middle) / fit.tilt);
    const auto around = static_cast<float>(4 * kForm / fit.around);
    const float half_square = 0.5f * glm::dot(t, t);
    for (std::uint32_t r = kFirstDegree; r < kAllDegrees; ++r) {
        const glm::mat3 b = second_harmonic(r - kFirstDegree + kSecond);
        const float straight = glm::dot(normal, b * normal);
        lobe[r] = bend * straight + tilt * glm::dot(normal, b * t) +
                  around * (glm::dot(t, b * t) + half_square * straight);
    }
    return lobe;
}

ViewMatrix to_harmonics(const ViewFit& fit, glm::vec3 normal) {
    // Y_00, and Y_1 = sqrt(3) Y_00 (y, z, x).
    constexpr auto kConstant = static_cast<float>(0.5 * std::numbers::inv_sqrtpi);
    constexpr auto kLinear = static_cast<float>(std::numbers::sqrt3) * kConstant;
    constexpr std::array<std::size_t, 3> kHarmonicOf{3, 1, 2};  // of x, y and z
    ViewMatrix matrix{};
    const auto add_linear = [&](std::uint32_t row, glm::vec3 slope, double constant) {
        matrix[0][row] += static_cast<float>(constant) / kConstant;
        for (int axis = 0; axis < 3; ++axis) {
            matrix[kHarmonicOf[static_cast<std::size_t>(axis)]][row] += slope[axis] / kLinear;
        }
    };
    for (std::uint32_t axis = 0; axis < kFirstDegree; ++axis) {
        glm::vec3 unit(0);
        unit[static_cast<int>(axis)] = 1;
        add_linear(axis, unit, -fit.mean * static_cast<double>(glm::dot(normal, unit)));
    }
    for (std::uint32_t r = kFirstDegree; r < kAllDegrees; ++r) {
        const std::uint32_t k = r - kFirstDegree + kSecond;
        matrix[k][r] = 1;
        const glm::vec3 image = second_harmonic(k) * normal;
        const float straight = glm::dot(normal, image);
        const glm::vec3 slope = static_cast<float>(-fit.slope) * straight * normal -
                                static_cast<float>(2 * fit.middle) * (image - straight * normal);
        add_linear(r, slope, -static_cast<double>(straight) * (fit.level - fit.slope * fit.mean));
    }
    return matrix;
}

}  // namespace opaline::bake
