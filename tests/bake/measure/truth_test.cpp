#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "bake/check/measure_error.h"
#include "bake/check/surface_probes.h"
#include "bake/effects/multiple/true_multiple.h"
#include "bake/effects/single/true_single.h"
#include "bake/lights/test_lights.h"
#include "bake/lights/true_irradiance.h"
#include "bake/physics/fresnel.h"
#include "bake/receivers/vertex_receivers.h"
#include "formats/opal/cubemap.h"
#include "tests/bake/single/single_support.h"
#include "tests/support/scenes.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

std::vector<TestLight> published_lights() {
    auto lights = make_test_lights(16, 2);
    EXPECT_TRUE(lights);
    return std::move(lights).value();
}

std::size_t place_of(std::span<const TestLight> lights, std::string_view name) {
    std::size_t l = 0;
    while (lights[l].name != name) {
        ++l;
    }
    return l;
}

double mean(const TwoEstimates& estimates, std::size_t light) {
    return 0.5 * (estimates.first[light] + estimates.second[light]);
}

TEST(ReflectionTruth, OpenFloorReflectsTheCosineOfEachSunAndAllOfTheSky) {
    const auto scene = tests::make_scene({tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 2)});
    const auto rays = RayScene::build(scene, 1);
    const std::vector<Receiver> receivers = make_vertex_receivers(scene);
    const std::vector<TestLight> lights = published_lights();
    std::uint64_t traced = 0;
    const TwoEstimates truth =
        eval_reflection(make_reflection_truth(lights), *rays, receivers[4], traced);
    const auto sine = [](double degrees) { return std::sin(degrees * std::numbers::pi / 180); };
    EXPECT_NEAR(mean(truth, place_of(lights, "white")), 1, 1e-4);
    EXPECT_NEAR(mean(truth, place_of(lights, "sun:30,60")), sine(60), 2e-4);
    EXPECT_NEAR(mean(truth, place_of(lights, "sun:150,35")), sine(35), 2e-4);
    EXPECT_NEAR(mean(truth, place_of(lights, "sun:270,15")), sine(15), 2e-4);
    EXPECT_GT(traced, 0u);
}

TEST(TestLights, CoarserCubeMapsHoldTheSameFlux) {
    std::vector<TestLight> lights = published_lights();
    for (const std::uint32_t n : {8u, 64u, 128u}) {
        const std::vector<TestLight> before = lights;
        project_test_lights(lights, n);
        for (std::size_t l = 0; l < lights.size(); ++l) {
            // The average of a face times n, times n: the integral over it.
            const auto flux = [](const TestLight& light) {
                const auto size = static_cast<std::uint32_t>(light.coarse.size() / 6);
                double sum = 0;
                for (std::size_t face = 0; face < 6; ++face) {
                    sum += double{light.coarse[face * size]} * std::sqrt(size);
                }
                return sum;
            };
            EXPECT_NEAR(flux(lights[l]) / flux(before[l]), 1, 1e-5) << lights[l].name << " " << n;
        }
    }
}

// Two hundred mean free paths wide, and the point lies where its large triangles meet.
TEST(SurfaceIntegral, MiddleOfALargeSquareReturnsTheProfilesTotal) {
    const auto setup = tests::set_up(
        tests::make_translucent_scene({tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 2)},
                                      tests::make_grey_medium(100, 0.5f)));
    const std::vector<TestLight> lights = published_lights();
    const MediumProfile profile = make_medium_profile(*setup.scene.materials[0].medium);
    const SurfaceIntegral integral = make_surface_integral(setup.scene, 0, profile);
    const SunRays suns = make_sun_rays(lights, 4);
    const SmoothLights smooth = make_smooth_lights(lights);
    const std::size_t white = place_of(lights, "white"), sun = place_of(lights, "sun:30,60");
    std::uint64_t traced = 0;
    const TwoEstimates found =
        integrate_multiple(integral, {setup.scene, setup.rays, suns, smooth, 1024},
                           setup.points[4].position, {0, 0}, traced);
    const double total = profile.total(1);
    EXPECT_NEAR(mean(found, white) / total, 1, 4e-3);
    const double cosine = std::sin(std::numbers::pi / 3);
    const double entering = fresnel_transmittance(cosine, 1.3) / profile.exit;
    EXPECT_NEAR(mean(found, sun) / (total * cosine * entering), 1, 2e-3);
    EXPECT_NE(found.first[white], found.second[white]);
}

TEST(SingleQuadrature, AgreesWithTransportOfAFineCubeMap) {
    const auto setup = tests::set_up(
        tests::make_translucent_scene({tests::make_sphere(3)}, tests::make_grey_medium(2, 0.2f)));
    const std::vector<TestLight> lights = published_lights();
    const SingleQuadrature quadrature = make_single_quadrature(setup.scene, 0, 16, lights);
    const DirectionSet directions = make_direction_set(32);
    const SingleMedium medium = make_single_medium(setup.scene, 0, 16);
    const std::vector<double> solid_angle = formats::texel_solid_angles(32);
    std::vector<float> row(3 * formats::cubemap_texels(32));
    std::uint64_t traced = 0;
    for (const std::size_t v : {0u, 40u, 100u}) {
        gather_single(setup.rays, directions, texel_shares(directions), medium, setup.points[v],
                      row);
        double expected = 0;
        for (std::size_t j = 0; j < row.size() / 3; ++j) {
            expected += double{row[row.size() / 3 + j]} * solid_angle[j % solid_angle.size()];
        }
        const Luminance found = integrate_single(quadrature, setup.rays, setup.points[v], traced);
        EXPECT_NEAR(found[place_of(lights, "white")] / expected, 1, 5e-3) << v;
    }
}

TEST(ErrorBounds, NoiseOfTheTruthIsNoError) {
    // Found values are right; two estimates of the truth err by 10 %, each by itself.
    std::vector<CheckedPair> pairs;
    for (int i = 0; i < 4000; ++i) {
        const auto u = random_uniform(1, RandomStage::check_points, static_cast<std::uint64_t>(i));
        pairs.push_back({{0.35 * (double{u[0]} - 0.5), 0.35 * (double{u[1]} - 0.5)}, 1.0});
    }
    EXPECT_LT(relative_rms(pairs), 0.02);
    for (CheckedPair& pair : pairs) {
        pair.error[0] += 0.05;
        pair.error[1] += 0.05;
    }
    const ErrorBounds bounds = bound_error(pairs, 4, 0);
    EXPECT_NEAR(bounds.rms, 0.05, 0.005);
    EXPECT_LT(bounds.lowest, 0.05);
    EXPECT_GT(bounds.highest, 0.05);
    EXPECT_LT(bounds.highest - bounds.lowest, 0.02);
}

std::string read(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void expect_same(const std::vector<TestLight>& a, const std::vector<TestLight>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t l = 0; l < a.size(); ++l) {
        EXPECT_EQ(a[l].name, b[l].name);
        EXPECT_EQ(a[l].smooth, b[l].smooth);
        EXPECT_EQ(a[l].coarse, b[l].coarse);
        ASSERT_EQ(a[l].discs.size(), b[l].discs.size());
        for (std::size_t d = 0; d < a[l].discs.size(); ++d) {
            EXPECT_EQ(a[l].discs[d].direction, b[l].discs[d].direction);
            EXPECT_EQ(a[l].discs[d].angular_radius, b[l].discs[d].angular_radius);
            EXPECT_EQ(a[l].discs[d].flux, b[l].discs[d].flux);
        }
    }
}

TEST(TestLightCache, LightsFromTheCacheAreTheSameBits) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path file = folder / "new" / "lights";
    EXPECT_TRUE(read_test_lights(file).empty());
    const auto plain = make_test_lights(16, 2), first = make_test_lights(16, 2, file);
    ASSERT_TRUE(plain && first);
    ASSERT_EQ(read_test_lights(file).size(), published_lights().size());
    const auto second = make_test_lights(16, 2, file);
    ASSERT_TRUE(second);
    expect_same(*plain, *first);
    expect_same(*plain, *second);
}

TEST(TestLightCache, DamagedFilesAreNotUsed) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path file = folder / "lights";
    ASSERT_TRUE(make_test_lights(8, 2, file));
    const std::string whole = read(file);
    for (std::size_t at = 0; at < whole.size(); at += whole.size() / 50) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x40);
        std::ofstream(file, std::ios::binary) << damaged;
        EXPECT_TRUE(read_test_lights(file).empty()) << at;
        std::ofstream(file, std::ios::binary) << whole.substr(0, at);
        EXPECT_TRUE(read_test_lights(file).empty()) << at;
    }
    std::ofstream(file, std::ios::binary) << whole;
    EXPECT_FALSE(read_test_lights(file).empty());
}

TEST(TestLightCache, CacheThatCannotBeWrittenChangesNothing) {
    EXPECT_TRUE(make_test_lights(8, 2, "/proc/no/such/folder/lights"));
}

std::vector<CheckPoint> draw(const formats::Scene& scene, std::size_t count,
                             const std::vector<std::uint32_t>& primitives, unsigned threads = 2) {
    const auto rays = RayScene::build(scene, 1);
    EXPECT_TRUE(rays);
    Context context;
    context.threads = threads;
    return draw_surface_probes(scene, *rays, primitives, {count, 5, 1000}, context);
}

TEST(SurfaceProbes, AreSharedOutByAreaAndLieWhereTheirWeightsSay) {
    // Areas 36 and 4.
    const auto scene = tests::make_scene({tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 3),
                                          tests::make_quad({9, 0, 0}, {0, 0, 2}, {2, 0, 0}, 40)});
    const auto probes = draw(scene, 400, {0, 1});
    ASSERT_EQ(probes.size(), 400u);
    std::size_t first = 0;
    glm::dvec3 mean(0);
    const auto vertices = static_cast<std::uint32_t>(scene.primitives[0].position.size());
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const CheckPoint& probe = probes[i];
        glm::vec3 mixed(0);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = probe.vertex[k] - (probe.primitive == 0 ? 0 : vertices);
            EXPECT_GE(probe.weight[k], 0);
            mixed += probe.weight[k] * scene.primitives[probe.primitive].position[v];
        }
        EXPECT_LT(glm::distance(mixed, probe.body.position), 1e-5f);
        EXPECT_NEAR(probe.weight[0] + probe.weight[1] + probe.weight[2], 1, 1e-6);
        EXPECT_EQ(probe.key, 1000 + i);
        if (probe.primitive == 0) {
            ++first;
            mean += glm::dvec3(probe.body.position);
        }
    }
    EXPECT_EQ(first, 360u);  // strata of equal area
    EXPECT_LT(glm::length(mean) / 360, 0.3);
}

TEST(SurfaceProbes, PrimitivesThatAreNotListedGetNone) {
    const auto scene = tests::make_scene({tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}),
                                          tests::make_quad({9, 0, 0}, {0, 0, 2}, {2, 0, 0})});
    for (const CheckPoint& probe : draw(scene, 50, {1})) {
        EXPECT_EQ(probe.primitive, 1u);
    }
    EXPECT_TRUE(draw(scene, 50, {}).empty());
}

TEST(SurfaceProbes, NoneLiesInsideABody) {
    // Half of the ball below the floor's plane: nobody sees the floor within it.
    const auto scene = tests::make_scene(
        {tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), tests::make_sphere(4)});
    const auto probes = draw(scene, 400, {0});
    // pi of 16 are hidden.
    EXPECT_NEAR(static_cast<double>(probes.size()), 400 * (1 - 3.1416 / 16), 32);
    for (const CheckPoint& probe : probes) {
        EXPECT_GT(glm::length(probe.body.position), 0.99f);
    }
}

TEST(SurfaceProbes, NormalsAreThoseOfTheSmoothSurfaceAndTheInnerPointLiesInside) {
    const auto scene = tests::make_scene({tests::make_sphere(2)});
    for (const CheckPoint& probe : draw(scene, 100, {0})) {
        const glm::vec3 out = glm::normalize(probe.body.position);
        EXPECT_GT(glm::dot(probe.body.normal, out), 0.999f);
        EXPECT_EQ(probe.body.normal, probe.receiver.normal);
        EXPECT_GT(glm::dot(probe.receiver.origin - probe.body.position, out), 0);
        EXPECT_LT(glm::dot(probe.body.inner - probe.body.position, out), 0);
        EXPECT_LT(glm::distance(probe.body.inner, probe.body.position), 1e-4f);
    }
}

}  // namespace

}  // namespace opaline::bake
