#include "bake/emitters/patch_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "bake/path_differentials/path_differential.h"
#include "tests/bake/path_differentials/random_inputs.h"

namespace opaline::bake {
namespace {

double total_power(const PatchElements& patch) {
    double sum = 0;
    for (const std::vector<double>& level : patch.power) {
        sum = std::accumulate(level.begin(), level.end(), sum);
    }
    return sum;
}

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(PatchElements, TakeTheLargestElementBelowTheFootprint) {
    const PatchElements patch = make_patch_elements(2, 5);
    EXPECT_EQ(element_level(patch, 3), 0);
    EXPECT_EQ(element_level(patch, 2), 0);
    EXPECT_EQ(element_level(patch, 1.9), 1);
    EXPECT_EQ(element_level(patch, 0.5), 1);
    EXPECT_EQ(element_level(patch, 0.49), 2);
    EXPECT_EQ(element_level(patch, 0), 4);
}

TEST(PatchElements, PushedDownPowerIsSpreadOverItsElementAlone) {
    PatchElements patch = make_patch_elements(4, 3);
    deposit(patch, 1, 0.9, 0.1, 3);
    deposit(patch, 2, 0.9, 0.1, 1);
    const std::vector<double> H = push_down(patch);
    ASSERT_EQ(H.size(), 16u);
    EXPECT_EQ(H[3], 3 / 1.0 + 1 / 0.25);
    EXPECT_EQ(H[2], 3);
    EXPECT_EQ(H[6], 3);
    EXPECT_EQ(H[1], 0);
    EXPECT_EQ(H[8], 0);
}

TEST(PatchElements, SumIsThePowerReceivedWhateverTheLevels) {
    tests::RandomInputs random(50);
    PatchElements patch = make_patch_elements(3, 8);
    double received = 0;
    for (int i = 0; i < 20000; ++i) {
        const double power = random.uniform(0, 1e-3);
        received += power;
        deposit(patch, element_level(patch, std::pow(10, random.uniform(-6, 1))),
                random.uniform(-0.01, 1.01), random.uniform(), power);
    }
    EXPECT_NEAR(total_power(patch), received, 1e-12 * received);
    EXPECT_NEAR(3 * mean_of(push_down(patch)), received, 1e-12 * received);
}

/// From a point of the unit square z = 0, with four numbers, to the plane z = 1.
struct Arrival {
    double s = 0, t = 0, footprint = 0;
};

Arrival fly_across(const std::array<double, 4>& x, const DifferentialRules& rules) {
    const glm::dvec3 up(0, 0, 1), still(0);
    PathDifferential path;
    add_variable(path, {{1, 0, 0}, still, 0, 1});
    add_variable(path, {{0, 1, 0}, still, 0, 1});
    const glm::dvec3 D = scatter_in_lobe(
        path, rules, {.axis = up, .map = DiskMap::polar, .u = x[2], .v = x[3], .N_g = up});
    move_to_surface(path, D, up, 1 / D.z);
    return {x[0] + D.x / D.z, x[1] + D.y / D.z,
            surface_footprint(path, rules, up, FootprintMode::polygon).area};
}

DifferentialRules particle_rules(double particles) {
    return {.steps = DifferentialRules::Steps::global,
            .samples = particles,
            .gradient_limit = 1e300,
            .extent = 100};
}

/// Irradiance at (s, t) from the parallel unit square of exitance 1 at distance 1: corners' sums of
/// the form factor of a point and a rectangle.
double irradiance_across(double s, double t) {
    const auto corner = [](double x, double y) {
        const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
        return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * std::numbers::pi);
    };
    return corner(1 - s, 1 - t) + corner(s, 1 - t) + corner(1 - s, t) + corner(s, t);
}

double relative_error(const std::vector<double>& H) {
    double error = 0, square = 0;
    for (std::size_t i = 0; i < H.size(); ++i) {
        const double exact = irradiance_across((static_cast<double>(i % 64) + 0.5) / 64,
                                               (static_cast<double>(i / 64) + 0.5) / 64);
        error += (H[i] - exact) * (H[i] - exact);
        square += exact * exact;
    }
    return std::sqrt(error / square);
}

/// Errors by footprint, and on one level of 0..6 alone.
struct LevelErrors {
    double by_footprint = 0, received = 0;
    std::array<double, 7> level{};
};

LevelErrors trace_across(int particles) {
    tests::RandomInputs random(51);
    std::vector<PatchElements> patches(8, make_patch_elements(1, 7));
    const DifferentialRules rules = particle_rules(particles);
    LevelErrors out;
    for (int i = 0; i < particles; ++i) {
        const std::array<double, 4> x{random.uniform(), random.uniform(), random.uniform(),
                                      random.uniform()};
        const Arrival at = fly_across(x, rules);
        if (at.s < 0 || at.s > 1 || at.t < 0 || at.t > 1) {
            continue;
        }
        const double power = 1.0 / particles;
        out.received += power;
        deposit(patches[7], element_level(patches[7], at.footprint), at.s, at.t, power);
        for (int level = 0; level < 7; ++level) {
            deposit(patches[static_cast<std::size_t>(level)], level, at.s, at.t, power);
        }
    }
    EXPECT_NEAR(total_power(patches[7]), out.received, 1e-12);
    for (std::size_t level = 0; level < 7; ++level) {
        out.level[level] = relative_error(push_down(patches[level]));
    }
    out.by_footprint = relative_error(push_down(patches[7]));
    return out;
}

void expect_near_the_best_level(const LevelErrors& errors) {
    const double best = *std::min_element(errors.level.begin(), errors.level.end());
    EXPECT_LE(errors.by_footprint, 1.15 * best);
}

// Closed form (2 / pi) (ln sqrt(4/3) + 2 sqrt 2 atan(1 / sqrt 2) - 2 atan 1).
constexpr double kFormFactor = 0.19982490;

TEST(ParticleRadiosity, BetweenParallelSquaresErrsNoMoreThanTheBestLevel) {
    const LevelErrors errors = trace_across(20000);
    EXPECT_NEAR(errors.received, kFormFactor, 3 * std::sqrt(0.2 * 0.8 / 20000));
    expect_near_the_best_level(errors);
    EXPECT_NEAR(errors.by_footprint, 0.087, 0.015);
}

TEST(ParticleRadiosity, ErrorFallsAsTheFourthRootOfTheirNumber) {
    const LevelErrors errors = trace_across(400000);
    EXPECT_NEAR(errors.received, kFormFactor, 3 * std::sqrt(0.2 * 0.8 / 400000));
    expect_near_the_best_level(errors);
    EXPECT_NEAR(errors.by_footprint, 0.0415, 0.004);
}

/// A face of the unit cube: where (0, 0) of it is, its sides, and its normal, inward.
struct BoxFace {
    glm::dvec3 origin{0}, S{0}, T{0}, N{0};
};

std::array<BoxFace, 6> box_faces() {
    std::array<BoxFace, 6> faces;
    for (int i = 0; i < 6; ++i) {
        const int axis = i / 2;
        BoxFace& face = faces[static_cast<std::size_t>(i)];
        face.S[(axis + 1) % 3] = 1;
        face.T[(axis + 2) % 3] = 1;
        face.origin[axis] = i % 2;
        face.N[axis] = i % 2 == 0 ? 1 : -1;
    }
    return faces;
}

// A closed box of exitance 1 and albedo 1/2: B = 1 / (1 - 1/2) everywhere, faces within 0.2 %.
TEST(ParticleRadiosity, FurnaceBoxIsEvenWithin2Permille) {
    const std::array<BoxFace, 6> faces = box_faces();
    const int particles = 200000;
    const double albedo = 0.5;
    const DifferentialRules rules = particle_rules(particles);
    std::vector<PatchElements> patches(6, make_patch_elements(1, 5));
    tests::RandomInputs random(52);
    double received = 0;
    for (int i = 0; i < particles; ++i) {
        // The first flight by a lattice [Roberts2018], and four bounces without roulette: less
        // noise.
        std::array<double, 4> start;
        for (std::size_t k = 0; k < 4; ++k) {
            const double turns =
                i / 6 * std::pow(1.1673039782614187, -1.0 - static_cast<double>(k));
            start[k] = turns - std::floor(turns);
        }
        double power = 6.0 / particles;
        std::size_t on = static_cast<std::size_t>(i % 6);
        PathDifferential path;
        path.survival = 1.0 / 6;  // the choice of the face
        add_variable(path, {faces[on].S, glm::dvec3(0), 0, 1});
        add_variable(path, {faces[on].T, glm::dvec3(0), 0, 1});
        glm::dvec3 P =
            faces[on].origin + random.uniform() * faces[on].S + random.uniform() * faces[on].T;
        for (int flight = 0;; ++flight) {
            aim_at_normal(path, glm::dmat3(0.0));
            const glm::dvec3 D = scatter_in_lobe(path, rules,
                                                 {.axis = faces[on].N,
                                                  .u = flight == 0 ? start[2] : random.uniform(),
                                                  .v = flight == 0 ? start[3] : random.uniform(),
                                                  .N_g = faces[on].N});
            double nearest = 1e300;
            const std::size_t from = on;
            for (std::size_t k = 0; k < 6; ++k) {
                const double facing = glm::dot(faces[k].N, D);
                const double t = glm::dot(faces[k].N, faces[k].origin - P) / facing;
                if (k != from && facing < 0 && t < nearest) {
                    nearest = t;
                    on = k;
                }
            }
            move_to_surface(path, D, faces[on].N, nearest);
            P += nearest * D;
            const double area =
                surface_footprint(path, rules, faces[on].N, FootprintMode::polygon).area;
            deposit(patches[on], element_level(patches[on], area),
                    glm::dot(P - faces[on].origin, faces[on].S),
                    glm::dot(P - faces[on].origin, faces[on].T), power);
            received += power;
            if (flight < 4) {
                power *= albedo;
                continue;
            }
            if (random.uniform() >= albedo) {
                break;
            }
            path.survival *= albedo;
        }
    }
    double total = 0;
    for (const PatchElements& patch : patches) {
        EXPECT_NEAR(1 + albedo * mean_of(push_down(patch)), 2, 0.004);
        total += total_power(patch);
    }
    EXPECT_NEAR(total, received, 1e-10 * received);
}

}  // namespace
}  // namespace opaline::bake
