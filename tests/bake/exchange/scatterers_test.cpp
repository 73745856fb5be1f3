#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bake/base/rng.h"
#include "bake/exchange/scatterers.h"
#include "bake/exchange/seen_light.h"
#include "bake/plan/surface_albedo.h"
#include "formats/opal/cubemap.h"
#include "tests/bake/exchange/bounce_support.h"
#include "tests/bake/exchange/textured_plates.h"

namespace opaline::bake {
namespace {

struct Found {
    std::vector<Scatterer> scatterers;
    std::uint64_t rays = 0;
};

Found find_in(formats::Scene scene, std::size_t count) {
    const tests::LitScene lit(std::move(scene));
    const std::vector<RowLayout> layouts = lit.layouts();
    const BakeInputs inputs = lit.inputs();
    const Knobs knobs;
    Found found;
    found.scatterers = find_scatterers({inputs, knobs, {}, layouts, {}, {}}, count, found.rays);
    return found;
}

TEST(Scatterers, LieWhereReceiversLook) {
    const Found found = find_in(tests::make_plates(0.5f, 0.5f, 8), 256);
    EXPECT_EQ(found.scatterers.size(), 256u);
    EXPECT_EQ(found.rays, 2u * 81 * 16);
    std::size_t upper = 0;
    for (const Scatterer& s : found.scatterers) {
        upper += s.material;
        EXPECT_NEAR(s.position.y, s.material == 1 ? 0.5 : 0, 1e-6);
        EXPECT_EQ(s.normal.y, s.material == 1 ? -1 : 1) << "the sides that face each other";
        EXPECT_FALSE(s.behind);
        EXPECT_NEAR(s.albedo.diffuse.g, 0.5, 1e-6);
        EXPECT_GT(s.outside.origin.y * s.normal.y, s.position.y * s.normal.y);
    }
    EXPECT_NEAR(static_cast<double>(upper), 128, 30);
}

TEST(Scatterers, ALoneConvexBodyHasNone) {
    EXPECT_TRUE(find_in(tests::make_scene({tests::make_sphere(2)}), 64).scatterers.empty());
}

TEST(Scatterers, SheetsAreSeenFromBothSides) {
    formats::Scene scene = tests::make_plates(0.5f, 0.5f, 8);
    scene.materials[0].sheet = formats::Sheet{};
    scene.primitives.push_back(tests::make_quad({0, -0.5f, 0}, {0, 0, 1}, {1, 0, 0}, 8));
    scene.primitives[2].material = 1;
    std::size_t front = 0, behind = 0;
    for (const Scatterer& s : find_in(scene, 512).scatterers) {
        if (s.material == 0) {
            (s.behind ? behind : front) += 1;
            EXPECT_EQ(s.normal.y, s.behind ? -1 : 1);
            EXPECT_EQ(s.outside.origin.y > 0, !s.behind);
            EXPECT_EQ(s.beyond.origin.y > 0, s.behind);
        }
    }
    EXPECT_GT(front, 50u);
    EXPECT_GT(behind, 50u);
}

std::vector<SidePoint> scattered(std::uint32_t count) {
    std::vector<SidePoint> points;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto u = random_uniform(1, RandomStage::bounce_rays, i);
        const bool behind = i % 4 == 0;
        points.push_back({{u[0], 0, u[1]}, {0, behind, {0, behind ? -1.0f : 1.0f, 0}}});
    }
    return points;
}

TEST(EvenChoice, EachSideHasItsShareAndNoPointComesTwice) {
    const auto points = scattered(4000);
    const auto chosen = choose_evenly(points, 400);
    EXPECT_EQ(chosen.size(), 400u);
    EXPECT_EQ(std::set<std::uint32_t>(chosen.begin(), chosen.end()).size(), 400u);
    std::size_t behind = 0;
    for (const std::uint32_t i : chosen) {
        behind += points[i].side.behind ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(behind), 100, 1);
    EXPECT_EQ(choose_evenly(points, 9000).size(), 4000u) << "all there are";
    EXPECT_TRUE(choose_evenly({}, 10).empty());
}

// 300 of one side over the unit square: cells of 1 / 300. Random choice leaves pairs closer than a
// tenth of the width of a cell; cells of as many neighbours each do not.
TEST(EvenChoice, ChosenPointsKeepTheirDistance) {
    const auto points = scattered(16000);
    const auto chosen = choose_evenly(points, 400);
    std::size_t close = 0;
    for (const std::uint32_t a : chosen) {
        for (const std::uint32_t b : chosen) {
            close += a != b && !points[a].side.behind && !points[b].side.behind &&
                             glm::distance(points[a].position, points[b].position) < 0.02f
                         ? 1
                         : 0;
        }
    }
    // At random: 300 of them with pi 0.02^2 300 = 0.38 others.
    EXPECT_LT(close, 20u);
}

TEST(EvenChoice, OfPointsAtOnePlaceEachComesOnce) {
    const std::vector<SidePoint> points(1000, {{1, 1, 1}, {0, false, {0, 1, 0}}});
    for (const std::size_t count : {1u, 7u, 999u, 1000u}) {
        const auto chosen = choose_evenly(points, count);
        EXPECT_EQ(chosen.size(), count);
        EXPECT_EQ(std::set<std::uint32_t>(chosen.begin(), chosen.end()).size(), count);
    }
}

// What is seen of a place under an even sky of radiance 1.
double see(const SeenLight& seen, const MetPlace& met, std::uint32_t n) {
    std::vector<float> row(seen.bands * formats::cubemap_texels(n));
    add_seen(seen, met, {1, 1, 1}, 0, seen.bands, row);
    const std::vector<double> solid_angles = formats::texel_solid_angles(n);
    double sum = 0;
    for (std::size_t i = 0; i < formats::cubemap_texels(n); ++i) {
        sum += static_cast<double>(row[i]) * solid_angles[i % solid_angles.size()];
    }
    return sum;
}

// A floor that no receiver sees, and one who looks at it from above.
TEST(SeenLight, OnlookersSeeWhatASurfaceSendsAndNothingOfItsBack) {
    formats::Scene scene =
        tests::make_scene({tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 4)});
    scene.materials[0].base_color = {0.6f, 0.4f, 0.2f};
    const tests::LitScene lit(std::move(scene));
    const std::vector<RowLayout> layouts = lit.layouts();
    const BakeInputs inputs = lit.inputs();
    const Knobs knobs;
    const Context context;
    LightInputs asked{inputs, knobs, context, layouts, {}};
    std::uint64_t rays = 0;
    EXPECT_EQ(solve_exchange(asked, place_exchange(asked, rays), {}, rays, Bounces::none), nullptr);
    std::vector<Receiver> onlookers;
    for (int i = 0; i < 64; ++i) {
        onlookers.push_back({{0, 0.5f + 0.01f * static_cast<float>(i), 0}, {0, -1, 0}});
    }
    asked.onlookers = onlookers;
    const auto light = solve_exchange(asked, place_exchange(asked, rays), {}, rays, Bounces::none);
    ASSERT_NE(light, nullptr);
    const DensitySpace space;
    for (const std::uint32_t n : {4u, 8u, 16u}) {
        const SeenLight seen = see_surfaces(*light, space, make_light_cells(n), 3, context);
        EXPECT_NEAR(see(seen, {{0.2f, 0, 0.1f}, {0, 1, 0}, 0, -1}, n), 0.6, 0.02) << n;
        EXPECT_EQ(see(seen, {{0.2f, 0, 0.1f}, {0, 1, 0}, 0, 1}, n), 0) << n;
    }
    const SeenLight grey = see_surfaces(*light, space, make_light_cells(8), 1, context);
    EXPECT_NEAR(see(grey, {{0, 0, 0}, {0, 1, 0}, 0, -1}, 8),
                0.2126 * 0.6 + 0.7152 * 0.4 + 0.0722 * 0.2, 0.02);
}

SurfacePoint middle_of(const formats::Scene& scene) {
    return make_surface_point(scene, {0, 0}, {0.25f, 0.25f, 0.5f});
}

TEST(SurfaceAlbedo, ColoursOfMaterialVerticesAndImageMultiply) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    formats::Primitive& p = scene.primitives[0];
    p.color.assign(p.position.size(), {0.5f, 1, 1});
    p.texcoord.assign(p.position.size(), {0.5f, 0.5f});
    scene.images.push_back({.width = 1, .height = 1, .rgba = {255, 255, 0, 255}});
    scene.materials[0].base_color_image = 0;
    const formats::Rgb c = eval_surface_albedo(scene, {}, middle_of(scene)).sum();
    EXPECT_NEAR(c.r, 0.25, 1e-4);
    EXPECT_NEAR(c.g, 0.5, 1e-4);
    EXPECT_NEAR(c.b, 0, 1e-4);
}

// Schlick's Fresnel term over cosine-weighted directions: F0 + (1 - F0) / 21.
TEST(SurfaceAlbedo, ASmoothMetalSendsTheMeanOfItsFresnelTerm) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    RowLayout layout;
    layout.mirrors = true;
    scene.materials[0].gloss.metallic = 1;
    scene.materials[0].gloss.roughness = 0;
    const formats::Rgb color = scene.materials[0].base_color;
    const formats::Rgb sent = eval_surface_albedo(scene, layout, middle_of(scene)).sum();
    EXPECT_NEAR(sent.g, color.g + (1 - color.g) / 21, 0.005);
    EXPECT_NEAR(sent.r, color.r + (1 - color.r) / 21, 0.005);
}

TEST(SurfaceAlbedo, AWhiteMetalOfAnyRoughnessSendsAllLight) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    RowLayout layout;
    layout.mirrors = true;
    scene.materials[0].base_color = {1, 1, 1};
    scene.materials[0].gloss.metallic = 1;
    for (const float roughness : {0.1f, 0.5f, 1.0f}) {
        scene.materials[0].gloss.roughness = roughness;
        EXPECT_NEAR(eval_surface_albedo(scene, layout, middle_of(scene)).sum().g, 1, 0.01)
            << roughness;
    }
}

TEST(SurfaceAlbedo, ADielectricSendsItsDiffuseLobeAndWhatItMirrors) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    RowLayout layout;
    layout.mirrors = true;
    scene.materials[0].base_color = {0, 0, 0};
    scene.materials[0].gloss = {.specular = 1};
    scene.materials[0].gloss.roughness = 0;
    const float mirrored = eval_surface_albedo(scene, layout, middle_of(scene)).sum().g;
    EXPECT_NEAR(mirrored, 0.04 + 0.96 / 21, 0.005);
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    const float all = eval_surface_albedo(scene, layout, middle_of(scene)).sum().g;
    EXPECT_GT(all, mirrored + 0.4f);
    EXPECT_LT(all, mirrored + 0.5f);
}

formats::Scene plates_of_mean() {
    formats::Scene scene = tests::make_plates(0.5f, 0.8f, 4);
    scene.materials[0].base_color = {0.4f, 0.4f, 0.4f};
    return scene;
}

// Of the upper plate's vertices, whose light comes from the lower one.
double difference_above(std::span<const double> a, std::span<const double> b) {
    double square = 0, all = 0;
    for (std::size_t v = a.size() / 2; v < a.size(); ++v) {
        square += (a[v] - b[v]) * (a[v] - b[v]);
        all += b[v] * b[v];
    }
    return std::sqrt(square / all);
}

// Halves of black and white: what cells do not blur stays.
TEST(TexturedBounces, ACoarseTextureIsSeenWhereItIs) {
    formats::Image8 halves{2, 1, {0, 0, 0, 255, 255, 255, 255, 255}};
    const tests::BouncedIn plates(tests::make_textured_plates(halves, 1));
    const std::vector<double> points = plates.light(false), means = plates.light(true);
    EXPECT_LT(difference_above(means, points), 1e-6) << "texels are wider than cells";
    double dark = 0, bright = 0;
    for (std::size_t v = plates.receivers.size() / 2; v < plates.receivers.size(); ++v) {
        (plates.receivers[v].origin.x < 0.5f ? dark : bright) += means[v];
    }
    EXPECT_GT(bright, 1.5 * dark);
}

// Through the whole bake.
TEST(TexturedBounces, FilesHoldTheLightOfTheMean) {
    const std::vector<std::string> effects{"direct", "interreflection"};
    const auto light_of = [&](const formats::Scene& scene) {
        const auto baked = tests::bake_scene(scene, tests::bounce_options(effects));
        std::vector<double> green;
        for (const formats::Rgb c : tests::relight(baked.asset.view(), "white")) {
            green.push_back(static_cast<double>(c.g));
        }
        return green;
    };
    const auto checker = light_of(tests::make_textured_plates(tests::make_checker(256), 1));
    EXPECT_LT(difference_above(checker, light_of(plates_of_mean())), 1e-3);
}

}  // namespace

}  // namespace opaline::bake
