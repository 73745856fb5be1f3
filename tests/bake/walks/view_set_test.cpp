#include "bake/effects/multiple/walks/view_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bake/base/frame.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

const glm::vec3 kSurfaceNormal = glm::normalize(glm::vec3(0.3f, -0.8f, 0.5f));

// What rows of a light hold of it along a view.
struct Rows {
    std::array<double, 1 + kAllDegrees> row{};
    ViewMatrix matrix;

    double seen(glm::vec3 view) const {
        std::array<float, 1 + kAllDegrees> harmonic{};
        formats::eval_spherical_harmonics({view.x, view.y, view.z}, harmonic);
        double sum = row[0];
        for (std::size_t r = 0; r < kAllDegrees; ++r) {
            for (std::size_t k = 0; k < harmonic.size(); ++k) {
                sum += row[r + 1] * static_cast<double>(matrix[k][r] * harmonic[k]);
            }
        }
        return sum;
    }
};

Rows rows_of(const ViewSet& views, const ViewFit& fit,
             const std::function<double(glm::vec3)>& light) {
    Rows rows{{}, to_harmonics(fit, kSurfaceNormal)};
    for (std::size_t v = 0; v < views.into.size(); ++v) {
        for (std::size_t r = 0; r < rows.row.size(); ++r) {
            rows.row[r] += static_cast<double>(views.share[v][r]) * light(-views.into[v]);
        }
    }
    return rows;
}

TEST(ViewSet, SharesAreThoseOfUniformLightThatEnters) {
    for (const double eta : {0.8, 1.0, 1.4}) {
        const ViewFit fit = make_view_fit(eta);
        const ViewSet views = make_view_set(fit, eta, kSurfaceNormal, 1);
        double sum = 0, cosine = 0;
        for (std::size_t v = 0; v < views.into.size(); ++v) {
            sum += static_cast<double>(views.share[v][0]);
            cosine +=
                static_cast<double>(views.share[v][0] * -glm::dot(views.into[v], kSurfaceNormal));
        }
        EXPECT_NEAR(sum, 1, 1e-5);
        EXPECT_NEAR(cosine, fit.mean, 4e-3) << eta;  // four cosines
    }
}

TEST(ViewSet, RowsHoldLightOfTheirDegree) {
    const Frame frame = make_frame(kSurfaceNormal);
    const auto linear = [](glm::vec3 w) { return static_cast<double>(2 + w.x - 0.5f * w.y); };
    const auto quadratic = [&](glm::vec3 w) {
        return linear(w) + static_cast<double>(0.7f * w.x * w.y + 0.4f * w.z * w.z);
    };
    for (const double eta : {1.0, 1.4}) {
        const ViewFit fit = make_view_fit(eta);
        const Rows four = rows_of(make_view_set(fit, eta, kSurfaceNormal, 4), fit, linear);
        const Rows nine = rows_of(make_view_set(fit, eta, kSurfaceNormal, 9), fit, quadratic);
        for (const float sine : {0.0f, 0.3f, 0.6f}) {
            const glm::vec3 view = frame.to_world({sine, 0, std::sqrt(1 - sine * sine)});
            EXPECT_NEAR(four.seen(view), linear(view), 5e-3) << eta << ' ' << sine;
            EXPECT_NEAR(nine.seen(view), quadratic(view), 5e-3) << eta << ' ' << sine;
        }
    }
}

// A thin sheet shows 1 - e^(-x / c'), which no row holds.
TEST(ViewSet, WhatRowsCanNotHoldIsRightInTheMeanAndNearlyAlongTheNormal) {
    const auto sheet = [](glm::vec3 w) {
        return -std::expm1(-0.5 / std::max(1e-3, static_cast<double>(glm::dot(w, kSurfaceNormal))));
    };
    const ViewFit fit = make_view_fit(1);
    for (const std::uint32_t count : {4u, 9u}) {
        const ViewSet views = make_view_set(fit, 1, kSurfaceNormal, count);
        const Rows rows = rows_of(views, fit, sheet);
        double mean = 0, squares = 0, truth = 0;
        for (std::size_t v = 0; v < views.into.size(); ++v) {
            const auto share = static_cast<double>(views.share[v][0]);
            const double difference = rows.seen(-views.into[v]) - sheet(-views.into[v]);
            mean += share * difference;
            squares += share * difference * difference;
            truth += share * sheet(-views.into[v]);
        }
        EXPECT_NEAR(mean / truth, 0, 3e-3) << count;
        const double along = rows.seen(kSurfaceNormal) - sheet(kSurfaceNormal);
        EXPECT_LT(std::abs(along), 0.5 * std::sqrt(squares)) << count;
        EXPECT_LT(std::sqrt(squares) / truth, count == 4 ? 0.1 : 0.05);
    }
}

}  // namespace
}  // namespace opaline::bake
