#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bake/lights/builtin_environment.h"
#include "bake/reference/random_stream.h"
#include "bake/reference/reference_receivers.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/bake/scattering/phase_support.h"

namespace opaline::tests {
namespace {

using formats::PhaseFunction;

std::vector<PhaseFunction> some_phase_functions() {
    std::vector<PhaseFunction> all{
        {}, rayleigh(), table_of({-1, -0.5f, 0.25f, 0.9f, 1}, {0.0f, 0.1f, 0.02f, 0.3f, 0.0f})};
    for (const double g : {-0.9, 5e-5, 0.3, 0.95})
        all.push_back(hg(g));
    for (const float rms : {0.05f, 0.4f, 1.0f})
        all.push_back(gaussian(rms));
    return all;
}

// The first three moments of the cosine, sampled and integrated.
TEST(ReferencePhase, CosinesAreDistributedAsTheirDensitySays) {
    for (const PhaseFunction& function : some_phase_functions()) {
        const bake::PhaseSampler sampler = bake::make_phase_sampler(function);
        double expected[3] = {}, total = 0;
        constexpr int kSteps = 100000;
        for (int i = 0; i < kSteps; ++i) {
            // Even in angle: narrow peaks lie at its ends.
            const double angle = std::numbers::pi * (i + 0.5) / kSteps, c = std::cos(angle);
            const double p = bake::pdf_phase(sampler, static_cast<float>(c)) * 2 *
                             std::numbers::pi * std::sin(angle) * std::numbers::pi / kSteps;
            total += p;
            expected[0] += p * c, expected[1] += p * c * c, expected[2] += p * c * c * c;
        }
        EXPECT_NEAR(total, 1, 2e-4);
        if (function.type == PhaseFunction::Type::henyey_greenstein) {
            EXPECT_NEAR(expected[0], function.g, 2e-4) << "g > 0 is forward";
        }
        constexpr int kSamples = 200000;
        double sum[3] = {};
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            bake::RandomStream random(7, 0, i);
            const double c = bake::sample_phase_cosine(sampler, [&] { return random.next(); });
            sum[0] += c, sum[1] += c * c, sum[2] += c * c * c;
        }
        for (const int k : {0, 1, 2}) {
            EXPECT_NEAR(sum[k] / kSamples, expected[k], 4.0 / std::sqrt(kSamples) * 0.7)
                << "type " << static_cast<int>(function.type) << " moment " << k + 1;
        }
    }
}

// The mean of 1 / pdf over sampled directions is the solid angle that they cover.
TEST(ReferenceLight, DensityIntegratesToOneAndItsSamplesGiveTheIrradiance) {
    for (const char* name : {"white", "studio", "sky:3,35", "sun:30,40"}) {
        const auto sky = bake::make_environment(name);
        ASSERT_TRUE(sky);
        const bake::LightSampler light = bake::make_light_sampler(
            *sky, glm::mat3(glm::rotate(glm::mat4(1), 0.5f, glm::vec3(0, 1, 0))));
        // Power over the sphere: sampled from the light, and evenly (the map alone), plus discs.
        bake::Moments sampled, evenly;
        double discs = 0;
        for (const formats::DistantDisc& disc : sky->discs) {
            discs += disc.radiance.g * formats::disc_solid_angle(disc.angular_radius);
        }
        for (std::uint32_t i = 0; i < 100000; ++i) {
            bake::RandomStream random(1, 0, i);
            const glm::vec3 d = bake::sample_light(light, random);
            // Rounding moves a few directions over a disc's edge, where there is neither light nor
            // density.
            const double pdf = bake::pdf_light(light, d);
            sampled.add(pdf > 0 ? glm::dvec3(bake::eval_light(light, d)) / pdf : glm::dvec3(0));
            const float y = 1 - 2 * random.next(), phi = 6.2831853f * random.next();
            const float r = std::sqrt(1 - y * y);
            const formats::Rgb l =
                formats::sample_map(*sky, {r * std::cos(phi), y, r * std::sin(phi)});
            evenly.add(4 * std::numbers::pi * glm::dvec3(l.r, l.g, l.b));
        }
        EXPECT_NEAR(sampled.mean.y, evenly.mean.y + discs,
                    4 * std::sqrt(sampled.variance_of_mean().y + evenly.variance_of_mean().y) +
                        1e-4 * discs + 1e-5)
            << name;
        // Importance: far less noise than even sampling has.
        if (std::string(name) == "studio") {
            EXPECT_LT(sampled.variance_of_mean().y, 0.1 * evenly.variance_of_mean().y);
        }
    }
}

TEST(ReferenceReceivers, DepthOneIsDirectLightOnly) {
    const auto corner = make_fixture(make_scene({make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 2),
                                                 make_quad({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, 2)}),
                                     make_white_sky());
    const auto receivers = bake::choose_receivers(corner->scene, 18, 0, std::nullopt);
    bake::EstimateOptions options;
    options.samples = 400;
    bake::PathOptions shallow, direct;
    shallow.max_depth = 1;
    direct.terms = formats::TermSet::diffuse;
    const auto a = bake::estimate_receivers(corner->space(shallow), receivers, options, {});
    const auto b = bake::estimate_receivers(corner->space(direct), receivers, options, {});
    const auto all = bake::estimate_receivers(corner->space(), receivers, options, {});
    ASSERT_TRUE(a && b && all);
    double gained = 0;
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        EXPECT_EQ(a->pixel[i].mean, b->pixel[i].mean);
        gained += all->pixel[i].mean.x - a->pixel[i].mean.x;
    }
    EXPECT_GT(gained, 0.1);
}

TEST(ReferenceImage, VarianceOfThePixelsTellsHowFarTwoSeedsAreApart) {
    Scene input = make_scene({make_sphere(3)});
    input.materials[0].medium = make_medium(5, 0.9f, 0, 1.4f);
    const auto ball = make_fixture(std::move(input), make_half_sky(true));
    runtime::Camera camera;
    camera.eye = {0, 1, 4};
    camera.width = 24;
    camera.height = 20;
    bake::EstimateOptions options;
    options.samples = 128;
    const auto a = bake::estimate_image(ball->space(), camera, options, {});
    options.seed = 1;
    const auto b = bake::estimate_image(ball->space(), camera, options, {});
    ASSERT_TRUE(a && b);
    double squares = 0, sum = 0, spread = 0;
    for (std::size_t i = 0; i < a->mean.pixel.size(); ++i) {
        const double variance = a->variance.pixel[i].r + b->variance.pixel[i].r;
        squares += std::pow(a->mean.pixel[i].r - b->mean.pixel[i].r, 2);
        sum += variance;
        spread += variance * variance;
    }
    // Of a squared difference twice its square; of a variance from twice 7 independent groups 2
    // / 14.
    EXPECT_NEAR(squares / sum, 1, 4 * std::sqrt((2 + 1.0 / 7) * spread) / sum);
}

TEST(NetPoints, OfTheFirst2PowKOneLiesInEveryElementaryInterval) {
    for (std::uint64_t key = 0; key < 50; ++key) {
        for (std::uint32_t count = 1; count <= 16; count *= 2) {
            for (std::uint32_t columns = 1; columns <= count; columns *= 2) {
                const std::uint32_t rows = count / columns;
                std::array<int, 16> found{};
                for (std::uint32_t i = 0; i < count; ++i) {
                    const glm::vec2 p = bake::net_point(bake::mix_bits(key), 3, i);
                    ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
                    const auto x = static_cast<std::uint32_t>(p.x * static_cast<float>(columns));
                    const auto y = static_cast<std::uint32_t>(p.y * static_cast<float>(rows));
                    ++found[y * columns + x];
                }
                for (std::uint32_t cell = 0; cell < count; ++cell) {
                    ASSERT_EQ(found[cell], 1) << columns << " x " << rows;
                }
            }
        }
    }
}

// Over keys, every point by itself is uniform, and so are two numbers of unlike pairs or two points
// of one pair where no net ties them.
TEST(NetPoints, APointIsUniformAndIndependentOfOtherPairs) {
    constexpr std::uint64_t kKeys = 20000;
    constexpr int kCells = 8;
    for (const std::uint32_t i : {0u, 5u, 15u}) {
        std::array<double, kCells * kCells> within{}, across{};
        for (std::uint64_t key = 0; key < kKeys; ++key) {
            const glm::vec2 p = bake::net_point(bake::mix_bits(key), 0, i);
            const glm::vec2 q = bake::net_point(bake::mix_bits(key), 1, i);
            const auto cell = [](float a, float b) {
                return static_cast<std::size_t>(a * kCells) * kCells +
                       static_cast<std::size_t>(b * kCells);
            };
            within[cell(p.x, p.y)] += 1;
            across[cell(p.x, q.x)] += 1;
        }
        double chi[2] = {};
        const double expected = static_cast<double>(kKeys) / (kCells * kCells);
        for (std::size_t c = 0; c < within.size(); ++c) {
            chi[0] += std::pow(within[c] - expected, 2) / expected;
            chi[1] += std::pow(across[c] - expected, 2) / expected;
        }
        const double freedom = kCells * kCells - 1;
        EXPECT_LT(chi[0], freedom + 4 * std::sqrt(2 * freedom)) << i;
        EXPECT_LT(chi[1], freedom + 4 * std::sqrt(2 * freedom)) << i;
    }
}

TEST(RandomStream, NumbersOfAnEventDoNotDependOnWhatWasDrawnBefore) {
    bake::RandomStream one(1, 2, 3), two(1, 2, 3);
    one.start_event();
    two.start_event();
    one.next();
    one.next_pair();
    one.start_event();
    two.start_event();
    EXPECT_EQ(one.next(), two.next());
    EXPECT_EQ(one.next_pair(), two.next_pair());
}

TEST(RandomStream, NoNumberComesTwice) {
    bake::RandomStream random(1, 2, 3);
    std::vector<float> seen;
    for (int event = 0; event < 12; ++event) {
        random.start_event();
        for (int i = 0; i < 25; ++i) {
            seen.push_back(random.next());
        }
    }
    std::sort(seen.begin(), seen.end());
    // By chance 300 numbers of 24 bits hold an equal pair once in 400 streams; this one has none.
    EXPECT_EQ(std::adjacent_find(seen.begin(), seen.end()), seen.end());
}

// Means of x y over the square, of as many samples as are asked for: unbiased for any number, and
// the stated errors are those that are found, or larger where there are few groups.
TEST(Estimate, StatedErrorsOfStratifiedSamplesAreHonest) {
    for (const std::uint32_t samples : {5u, 16u, 40u, 160u}) {
        bake::EstimateOptions options;
        options.samples = samples;
        const auto estimate =
            bake::estimate_pixels(2000, options, {}, [](std::uint32_t, bake::RandomStream& random) {
                random.start_event();
                const glm::vec2 p = random.next_pair();
                return bake::PathSample{glm::vec3(p.x * p.y), false, 0};
            });
        ASSERT_TRUE(estimate);
        double sum = 0, squares = 0, stated = 0;
        for (const bake::Moments& m : estimate->pixel) {
            sum += m.mean.x - 0.25;
            squares += std::pow(m.mean.x - 0.25, 2);
            stated += m.variance_of_mean().x;
        }
        EXPECT_LT(std::abs(sum), 4 * std::sqrt(squares)) << samples;
        const double independent = (1.0 / 9 - 1.0 / 16) * 2000 / samples;
        if (samples >= 64) {
            EXPECT_NEAR(squares / stated, 1, 0.15) << samples;
        } else {
            EXPECT_LT(squares, 1.1 * stated) << samples;
            EXPECT_NEAR(stated / independent, 1, 0.3) << samples;
        }
        EXPECT_LT(squares, 0.5 * independent) << samples;
    }
}

}  // namespace

}  // namespace opaline::tests
