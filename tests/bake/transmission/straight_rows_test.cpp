#include "bake/effects/transmission/straight_rows.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/effects/transmission/view_fit.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "formats/opal/spherical_harmonics.h"
#include "tests/bake/transmission/straight_body.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSize = 8;

RowLayout layout_of(std::uint32_t terms) {
    RowLayout layout;
    layout.translucent = layout.constant = layout.grey = true;
    layout.straight_harmonics = terms > 1 ? terms : 0;
    layout.separate = terms == 1;
    return layout;
}

// The texels' values of a receiver's rows, term by term.
std::vector<float> rows_of(const tests::CrossedBody& crossed, std::size_t vertex,
                           std::uint32_t terms, std::uint32_t views) {
    const tests::Primitive& p = crossed.scene.primitives[0];
    std::vector<float> values(terms * formats::cubemap_texels(kSize));
    const BodyPoint point{p.position[vertex], p.normal[vertex],
                          p.position[vertex] - 1e-4f * p.normal[vertex], 0};
    const DenseRow row{values, kSize, terms, 1};
    add_straight(crossed.body, point, views, layout_of(terms), row);
    std::vector<float> scratch(kSize * kSize);
    for (std::size_t face = 0; face < 6 * terms; ++face) {
        formats::haar_inverse(std::span(values).subspan(face * kSize * kSize, kSize * kSize), kSize,
                              scratch);
    }
    return values;
}

// Toward a direction inside, under light of radiance 1 from where `accept` says so.
template <class Accept>
double seen_along(const std::vector<float>& values, std::uint32_t terms, glm::vec3 inside,
                  Accept&& accept) {
    std::vector<float> h(terms, 1.0f);
    if (terms > 1) {
        formats::eval_spherical_harmonics({inside.x, inside.y, inside.z}, h);
    }
    const std::vector<double> solid_angle = formats::texel_solid_angles(kSize);
    const std::size_t texels = formats::cubemap_texels(kSize);
    double sum = 0;
    for (std::uint32_t k = 0; k < terms; ++k) {
        for (std::uint32_t j = 0; j < texels; ++j) {
            const std::uint32_t at = j % (kSize * kSize);
            const formats::Vec3 w =
                formats::texel_direction(kSize, j / (kSize * kSize), at / kSize, at % kSize);
            if (accept(glm::vec3(w.x, w.y, w.z))) {
                sum += double{h[k]} * double{values[k * texels + j]} * solid_angle[at];
            }
        }
    }
    return sum;
}

constexpr auto kAll = [](glm::vec3) { return true; };

TEST(StraightRows, AClearBallInAFurnaceShowsOneInEveryViewWithOneFourAndNineRows) {
    for (const double eta : {1.0, 1.5}) {
        const auto ball = tests::make_crossed({tests::make_sphere(3)}, eta, 0);
        for (const std::uint32_t terms : {1u, 4u, 9u}) {
            const auto values = rows_of(*ball, 17, terms, 64);
            const glm::vec3 normal = ball->scene.primitives[0].normal[17];
            for (const glm::vec3 seen : spread_views(normal, eta, 8, {0.5f, 0}).seen) {
                EXPECT_NEAR(seen_along(values, terms, seen, kAll), 1, 0.002) << eta << ' ' << terms;
            }
        }
    }
}

// A slab of index 1 shows of a sky that is bright in one half of the azimuth, e^(-sigma_t d / c) on
// the other side of the view, where the lights' edge is far: one row cannot know it, nine do.
TEST(StraightRows, RowsByViewKnowOnWhichSideTheLightIs) {
    const auto slab = tests::make_crossed({tests::make_crossed_slab(0.01f)}, 1, 0);
    const std::size_t middle = slab->scene.primitives[0].position.size() - 1;
    const auto bright = [](glm::vec3 w) { return w.x > 0; };
    const glm::vec3 seen = glm::normalize(glm::vec3(-0.7f, 0.7f, 0));
    const glm::vec3 mirrored(-seen.x, seen.y, 0);
    const auto one = rows_of(*slab, middle, 1, 256), nine = rows_of(*slab, middle, 9, 256);
    EXPECT_NEAR(seen_along(one, 1, seen, bright), 0.5, 0.03);
    EXPECT_GT(seen_along(nine, 9, seen, bright), 0.85);
    EXPECT_LT(seen_along(nine, 9, mirrored, bright), 0.15);
    EXPECT_NEAR(seen_along(nine, 9, seen, bright) + seen_along(nine, 9, mirrored, bright), 1, 0.06);
}

TEST(StraightRows, LightOfAViewIsSpreadOverADiscAroundItsExitAndKeepsItsEnergy) {
    EXPECT_NEAR(2 * std::numbers::pi * (1 - spread_cosine(64)) * 64, 2 * std::numbers::pi, 1e-9);
    const auto slab = tests::make_crossed({tests::make_crossed_slab(0.01f)}, 1, 0);
    const auto values = rows_of(*slab, slab->scene.primitives[0].position.size() - 1, 1, 64);
    // The mean over views of a clear slab is the cosine lobe behind it, 2 c dc, as directions.
    const auto steep = [](glm::vec3 w) { return w.y < -std::numbers::sqrt2_v<float> / 2; };
    EXPECT_NEAR(seen_along(values, 1, {0, 1, 0}, steep), 0.5, 0.05);
    EXPECT_NEAR(seen_along(values, 1, {0, 1, 0}, [](glm::vec3 w) { return w.y < 0.3f; }), 1, 0.01);
}

// Wherever its points are, behind a slab without an end is the same: no vertex has views of its own
// between those of others.
TEST(StraightRows, PointsOfASlabShowTheSame) {
    tests::Primitive mesh = tests::make_crossed_slab(0.01f);
    mesh.position.push_back(mesh.position.back() + glm::vec3(0.0123f, 0, -0.0077f));
    mesh.normal.push_back(mesh.normal.back());
    const auto slab = tests::make_crossed({mesh}, 1.5, 0);
    const auto one = rows_of(*slab, mesh.position.size() - 1, 4, 32);
    const auto other = rows_of(*slab, mesh.position.size() - 2, 4, 32);
    double difference = 0, size = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        difference += std::abs(double{one[i]} - double{other[i]});
        size += std::abs(double{one[i]});
    }
    EXPECT_LT(difference, 1e-3 * size);
}

// A sun in any one texel, which the least squares of few views would answer by light below zero on
// the other side of the view.
TEST(StraightRows, NoSunMakesAViewDarkerThanNothing) {
    const auto ball = tests::make_crossed({tests::make_sphere(3)}, 1.5, 0.2f);
    const glm::vec3 normal = ball->scene.primitives[0].normal[17];
    const std::size_t texels = formats::cubemap_texels(kSize);
    constexpr std::uint32_t kTerms = 4;
    const auto values = rows_of(*ball, 17, kTerms, 64);
    double least = 0, most = 0;
    for (const glm::vec3 seen : spread_views(normal, 1.5, 100, {0.5f, 0}).seen) {
        std::vector<float> h(kTerms);
        formats::eval_spherical_harmonics({seen.x, seen.y, seen.z}, h);
        for (std::size_t j = 0; j < texels; ++j) {
            double sum = 0;
            for (std::uint32_t k = 0; k < kTerms; ++k) {
                sum += double{h[k]} * double{values[k * texels + j]};
            }
            least = std::min(least, sum);
            most = std::max(most, sum);
        }
    }
    EXPECT_GT(least, -0.06 * most);
}

// Under a sky of which one half is bright, of vertices of a ball of glass.
TEST(StraightRows, FewViewsOfABallErrByLittle) {
    const auto ball = tests::make_crossed({tests::make_sphere(2)}, 1.5, 0);
    const tests::Primitive& mesh = ball->scene.primitives[0];
    const auto bright = [](glm::vec3 w) { return w.y + 0.3f * w.x > 0; };
    constexpr double kOutside = 0.7;  // of the normal: views at 45 degrees and a half
    double squares = 0;
    std::size_t count = 0;
    for (std::size_t v = 0; v < mesh.position.size(); v += 16, ++count) {
        const glm::vec3 side = glm::normalize(glm::cross(mesh.normal[v], glm::vec3(0.3f, 0.2f, 1)));
        const auto tilt = static_cast<float>(kOutside / 1.5);
        const glm::vec3 seen = std::sqrt(1 - tilt * tilt) * mesh.normal[v] + tilt * side;
        const double few = seen_along(rows_of(*ball, v, 4, 32), 4, seen, bright);
        const double many = seen_along(rows_of(*ball, v, 4, 512), 4, seen, bright);
        squares += (few - many) * (few - many);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(count)), 0.025);
}

// A matched ball so dense that only views past the facets of its own vertex could bring light.
TEST(StraightRows, OfADenseFacetedBallHoldNoLightPastTheFacetsOfTheVertex) {
    const auto ball = tests::make_crossed({tests::make_sphere(2)}, 1, 1000);
    const auto values = rows_of(*ball, 17, 1, 1024);
    EXPECT_LT(seen_along(values, 1, {0, 1, 0}, kAll), 1e-4);
}

TEST(ViewFit, HoldsWhatIsLinearInTheViewWithinItsSmoothing) {
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0.9f, -0.2f));
    const TransmissionViews views = spread_views(normal, 1, 256, {0.5f, 0});
    const TransmissionViews many = spread_views(normal, 1, 8192, {0.25f, 0.3f});
    const auto value = [&](glm::vec3 w) { return 2 + glm::dot(w, glm::vec3(0.5f, -0.7f, 0.4f)); };
    for (const std::uint32_t terms : {4u, 9u}) {
        const std::vector<float> factors = fit_views(views, terms);
        std::vector<double> rows(terms);
        for (std::size_t i = 0; i < views.seen.size(); ++i) {
            for (std::uint32_t k = 0; k < terms; ++k) {
                rows[k] += double{factors[i * terms + k]} * double{value(views.seen[i])};
            }
        }
        for (const glm::vec3 seen : spread_views(normal, 1, 16, {0.5f, 0.2f}).seen) {
            std::vector<float> h(terms);
            formats::eval_spherical_harmonics({seen.x, seen.y, seen.z}, h);
            double fitted = 0, mean = 0, by_kernel = 0;
            const ViewKernel kernel(normal, 1, terms, seen);
            for (std::uint32_t k = 0; k < terms; ++k) {
                fitted += rows[k] * double{h[k]};
            }
            for (std::size_t i = 0; i < many.seen.size(); ++i) {
                mean += many.weight[i] * kernel(many.seen[i]);
                by_kernel += many.weight[i] * kernel(many.seen[i]) * double{value(many.seen[i])};
            }
            EXPECT_NEAR(fitted, value(seen), 0.03);
            EXPECT_NEAR(mean, 1, 0.005);
            EXPECT_NEAR(by_kernel, fitted, 0.01) << "the truth sees the same";
        }
    }
}

TEST(ViewFit, AMatchedBoundaryHasHalfOfItsViewsWithin45DegreesOfTheNormal) {
    const TransmissionViews views = spread_views({0, 0, 1}, 1, 1000, {0.5f, 0});
    double steep = 0;
    for (std::size_t i = 0; i < views.seen.size(); ++i) {
        steep += views.seen[i].z > std::numbers::sqrt2_v<float> / 2 ? views.weight[i] : 0;
    }
    EXPECT_NEAR(steep, 0.5, 0.002);
}

}  // namespace
}  // namespace opaline::bake
