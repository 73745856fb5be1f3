#include "bake/effects/multiple/walks/view_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/physics/fresnel.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

const glm::vec3 kNormal = glm::normalize(glm::vec3(0.3f, -0.8f, 0.5f));

// Visits directions inside, toward the eye, with weights of sum 1: uniform light from outside, in
// reverse.
template <class Visit>
void visit_views(double eta, glm::vec3 normal, Visit&& visit) {
    constexpr int kCosines = 1000, kAzimuths = 16;
    const double least = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
    const auto cosine_of = [&](int i) { return least + (1 - least) * (i + 0.5) / kCosines; };
    const auto weight_of = [&](double c) { return c * fresnel_transmittance(c, eta); };
    double all = 0;
    for (int i = 0; i < kCosines; ++i) {
        all += kAzimuths * weight_of(cosine_of(i));
    }
    const Frame frame = make_frame(normal);
    for (int i = 0; i < kCosines; ++i) {
        const double c = refracted_cosine(cosine_of(i), eta), s = std::sqrt(1 - c * c);
        for (int k = 0; k < kAzimuths; ++k) {
            const double angle = 2 * std::numbers::pi * (k + 0.5) / kAzimuths;
            visit(frame.to_world({s * std::cos(angle), s * std::sin(angle), c}),
                  weight_of(cosine_of(i)) / all);
        }
    }
}

float quadratic(glm::vec3 w) {
    return 2 + w.x - 0.5f * w.y + 0.7f * w.z + 1.5f * w.x * w.y - 0.4f * w.y * w.z +
           0.9f * w.x * w.z + 0.8f * w.z * w.z - 0.6f * w.x * w.x;
}

float seen_along(const std::array<float, 9>& harmonics, glm::vec3 w) {
    std::array<float, 9> value{};
    formats::eval_spherical_harmonics({w.x, w.y, w.z}, value);
    float sum = 0;
    for (std::size_t k = 0; k < value.size(); ++k) {
        sum += harmonics[k] * value[k];
    }
    return sum;
}

// Rows by view of a light, and with its mean the harmonics that a file holds.
struct FittedLight {
    ViewLobe rows{};
    std::array<float, 9> harmonics{};
    double mean = 0;
};
template <class Light>
FittedLight fit_light(double eta, bool second, Light&& light) {
    const ViewFit fit = make_view_fit(eta);
    std::array<double, kAllDegrees> rows{};
    FittedLight fitted;
    visit_views(eta, kNormal, [&](glm::vec3 w, double weight) {
        const ViewLobe lobe = eval_view_lobe(fit, kNormal, w, second);
        const auto value = static_cast<double>(light(w));
        fitted.mean += weight * value;
        for (std::size_t r = 0; r < lobe.size(); ++r) {
            rows[r] += weight * value * static_cast<double>(lobe[r]);
        }
    });
    const ViewMatrix matrix = to_harmonics(fit, kNormal);
    fitted.harmonics[0] = static_cast<float>(fitted.mean * 2 * std::sqrt(std::numbers::pi));
    for (std::size_t r = 0; r < rows.size(); ++r) {
        fitted.rows[r] = static_cast<float>(rows[r]);
        for (std::size_t k = 0; k < matrix.size(); ++k) {
            fitted.harmonics[k] += matrix[k][r] * fitted.rows[r];
        }
    }
    return fitted;
}

TEST(ViewFit, HoldsLightThatIsQuadraticInTheViewExactlyWithNineRowsAndNotWithFour) {
    for (const double eta : {0.8, 1.0, 1.3, 1.8}) {
        const FittedLight nine = fit_light(eta, true, quadratic);
        const FittedLight four = fit_light(eta, false, quadratic);
        double worst = 0, worst_of_four = 0;
        visit_views(eta, kNormal, [&](glm::vec3 w, double) {
            const auto off = [&](const FittedLight& light) {
                return std::abs(static_cast<double>(seen_along(light.harmonics, w) - quadratic(w)));
            };
            worst = std::max(worst, off(nine));
            worst_of_four = std::max(worst_of_four, off(four));
        });
        EXPECT_LT(worst, 2e-3) << eta;
        EXPECT_GT(worst_of_four, 0.1) << eta;
    }
}

// Whatever the rows, as where those of other normals are mixed: outgoing flux stays exact.
TEST(ViewFit, MeanOverTheViewsIsThatOfTheFirstRowWhateverTheOthersAre) {
    for (const double eta : {0.8, 1.0, 1.3, 1.8}) {
        const ViewMatrix matrix = to_harmonics(make_view_fit(eta), kNormal);
        for (std::size_t r = 0; r < kAllDegrees; ++r) {
            std::array<float, 9> harmonics{};
            for (std::size_t k = 0; k < matrix.size(); ++k) {
                harmonics[k] = matrix[k][r];
            }
            double mean = 0;
            visit_views(eta, kNormal, [&](glm::vec3 w, double weight) {
                mean += weight * static_cast<double>(seen_along(harmonics, w));
            });
            EXPECT_NEAR(mean, 0, 1e-4) << eta << " " << r;
        }
    }
}

}  // namespace
}  // namespace opaline::bake
