#include "bake/exchange/narrow_lobe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "bake/effects/interreflection/interreflection.h"
#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/scatterers.h"
#include "bake/plan/surface_albedo.h"
#include "bake/reference/glossy_brdf.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/bake/exchange/bounce_support.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kSkyPlane = std::size_t{6} * kBounceCubemap * kBounceCubemap;

// Walls with one gloss.
struct GlossyWalls {
    GlossyWalls(std::vector<tests::Primitive> walls, formats::Gloss gloss, formats::Rgb color)
        : scene(tests::make_scene(std::move(walls))) {
        scene.materials[0].base_color = color;
        scene.materials[0].gloss = gloss;
        rays = RayScene::build(scene, 1).value();
        layouts[0].mirrors = true;
    }
    BounceSpace space() const { return {scene, rays, layouts}; }

    formats::Scene scene;
    RayScene rays = RayScene::build({}, 1).value();
    std::vector<RowLayout> layouts = std::vector<RowLayout>(1);
};

// E of a point, band by band, under radiance 1 of the texels whose middle `is_lit`.
template <class IsLit>
std::array<double, 3> irradiance_before(const GlossyWalls& walls, const Receiver& at,
                                        IsLit&& is_lit) {
    const BounceTree tree({}, 1, 3 * kSkyPlane);
    std::vector<NodeWeight> weights;
    weigh_bounces(walls.space(), tree, at, make_bounce_grid(65536), 1, weights);
    std::vector<float> row(3 * kSkyPlane), light(kSkyPlane);
    add_node_rows(tree, weights, row);
    const std::vector<double> face = formats::texel_solid_angles(kBounceCubemap);
    for (std::uint32_t t = 0; t < kSkyPlane; ++t) {
        const std::uint32_t own = t % static_cast<std::uint32_t>(face.size());
        const formats::Vec3 d =
            formats::texel_direction(kBounceCubemap, t / static_cast<std::uint32_t>(face.size()),
                                     own / kBounceCubemap, own % kBounceCubemap);
        light[t] = is_lit(glm::vec3(d.x, d.y, d.z)) ? static_cast<float>(face[own]) : 0;
    }
    formats::haar_forward_cube(std::span<float>(light), kBounceCubemap);
    std::array<double, 3> sum{};
    for (std::size_t t = 0; t < row.size(); ++t) {
        sum[t / kSkyPlane] +=
            static_cast<double>(row[t]) * static_cast<double>(light[t % kSkyPlane]);
    }
    return sum;
}

// A point on a floor before a wall of brass that faces +x has of the sky what path tracing's lobe
// sends to it, int int f(o, l) l.n (o.y) dl do: most of it from above and before the wall, from
// where a mirror would, in the metal's colour. It would come from all sides alike if the lobe were
// diffuse.
TEST(NarrowLobe, AMetalWallSendsTheFloorTheSkyThatItMirrorsInItsColour) {
    constexpr float kRoughness = 0.3f;
    const formats::Rgb brass{0.9f, 0.6f, 0.2f};
    const GlossyWalls wall({tests::make_quad({0, -40, -40}, {0, 80, 0}, {0, 0, 80})},
                           {.metallic = 1, .roughness = kRoughness}, brass);
    const OpaqueSurface surface{
        .base_color = {brass.r, brass.g, brass.b}, .metallic = 1, .roughness = kRoughness};
    const auto is_high = [](glm::vec3 d) { return d.x > 0 && d.y > 0.5f; };
    const auto is_low = [](glm::vec3 d) { return d.x > 0 && d.y < 0; };
    constexpr int kRays = 24, kSamples = 48;
    std::array<double, 3> high{}, low{}, all{};
    for (int i = 0; i < kRays; ++i) {
        for (int j = 0; j < kRays; ++j) {
            const float up = (static_cast<float>(i) + 0.5f) / kRays;
            const float azimuth =
                std::numbers::pi_v<float> * ((static_cast<float>(j) + 0.5f) / kRays + 0.5f);
            const float across = std::sqrt(1 - up * up);
            const glm::vec3 ray(across * std::cos(azimuth), up, across * std::sin(azimuth));
            const GlossyBrdf brdf = make_glossy_brdf(surface, {1, 0, 0}, -ray);
            for (int k = 0; k < kSamples * kSamples; ++k) {
                const auto sample =
                    sample_mirrored(brdf, (static_cast<float>(k % kSamples) + 0.5f) / kSamples,
                                    (static_cast<float>(k / kSamples) + 0.5f) / kSamples);
                if (!sample) continue;
                for (int b = 0; b < 3; ++b) {
                    const double part = std::numbers::pi / (kRays * kRays) * double{up} *
                                        double{sample->weight[b]} / (kSamples * kSamples);
                    const auto band = static_cast<std::size_t>(b);
                    all[band] += part;
                    high[band] += sample->direction.y > 0.5f ? part : 0;
                    low[band] += sample->direction.y < 0 ? part : 0;
                }
            }
        }
    }
    const Receiver floor{{1e-3f, 0, 0}, {0, 1, 0}};
    const auto found = irradiance_before(wall, floor, [](glm::vec3) { return true; });
    const auto found_high = irradiance_before(wall, floor, is_high);
    const auto found_low = irradiance_before(wall, floor, is_low);
    for (std::size_t b = 0; b < 3; ++b) {
        EXPECT_NEAR(found[b], all[b], 0.01 * all[b]) << b;
        EXPECT_NEAR(found_high[b], high[b], 0.04 * all[b]) << b;
        EXPECT_NEAR(found_low[b], low[b], 0.02 * all[b]) << b;
    }
    EXPECT_LT(low[1], 0.1 * all[1]) << "half of it, were the lobe diffuse";
}

// Of a floor's vertices by a 4 m high wall at x = 0, in two ranges of x, as a bake shows them under
// a sun 60 degrees above the horizon that shines on the wall.
std::array<double, 2> sunny_floor(bool has_wall) {
    formats::Scene scene = tests::make_scene(
        {tests::make_quad({0, 0, -4}, {0, 0, 8}, {8, 0, 0}, 20),
         tests::make_quad({0, has_wall ? 0.0f : -9.0f, -8}, {0, 4, 0}, {0, 0, 16}, 4)});
    scene.materials[0].base_color = {0.1f, 0.1f, 0.1f};
    scene.materials.push_back({.name = "Wall", .gloss = {.metallic = 1, .roughness = 0.1f}});
    scene.primitives[1].material = scene.primitives[1].node = 1;
    BakeOptions options = tests::bounce_options({"direct", "gloss", "interreflection"});
    options.set(kBounceRays, 400);
    const BakeResult baked = tests::bake_scene(scene, options);
    const std::vector<formats::Rgb> shown = tests::relight(baked.asset.view(), "sun:90,60");
    std::array<double, 2> sum{}, count{};
    const std::vector<glm::vec3>& position = scene.primitives[0].position;
    for (std::size_t v = 0; v < position.size(); ++v) {
        const float x = position[v].x;
        if (std::abs(position[v].z) > 2) continue;
        const bool is_near = x > 0.3f && x<1.3f, is_far = x> 4.5f && x < 7;
        if (!is_near && !is_far) continue;
        sum[is_near ? 0 : 1] += double{shown[v].g};
        count[is_near ? 0 : 1] += 1;
    }
    return {sum[0] / count[0], sum[1] / count[1]};
}

// The sun in a mirror stands as high as the sun: up to 2.3 m from the wall the floor is twice as
// bright as without it, beyond the blur of rows not brighter. With its light spread over all
// directions it would be 1.3 times as bright.
TEST(NarrowLobe, AFloorBeforeAMetalWallHasTheSunTwice) {
    const auto with = sunny_floor(true), without = sunny_floor(false);
    EXPECT_NEAR(with[0] / without[0], 2, 0.15);
    EXPECT_NEAR(with[1] / without[1], 1, 0.03);
}

// What a point's rays bring under an even sky that scatterers on walls see as well, over what it
// would be without walls. One scatterer answers for a wall.
double shares_of_rays(const GlossyWalls& walls, const Receiver& at, std::uint32_t rays) {
    const SurfacePoint point = make_surface_point(walls.scene, {0, 0}, {0.3f, 0.3f, 0.4f});
    std::vector<Scatterer> scatterers;
    for (int i = 0; i < 6; ++i) {
        Scatterer s;
        s.normal[i % 3] = i < 3 ? 1.0f : -1.0f;
        s.position = -s.normal;
        s.albedo = eval_surface_albedo(walls.scene, walls.layouts[0], point);
        scatterers.push_back(s);
    }
    const BounceTree tree(scatterers, 1, kSkyPlane);
    std::vector<NodeWeight> weights;
    const BounceGather gathered =
        weigh_bounces(walls.space(), tree, at, make_bounce_grid(rays), 1, weights);
    double sum = 0;
    for (const NodeWeight& w : weights) {
        sum += double{w.weight} *
               (w.node < tree.size() ? double{scatterers[0].albedo.diffuse.g} : 1.0);
    }
    return sum / double{gathered.met};
}

TEST(NarrowLobe, WhiteMetalsAndWhiteSurfacesWithCoatsSendAllLightOfARay) {
    for (const float roughness : {0.0f, 0.1f, 0.45f}) {
        for (const formats::Gloss& gloss :
             {formats::Gloss{.metallic = 1, .roughness = roughness},
              formats::Gloss{.roughness = roughness, .specular = 1, .ior = 2}}) {
            const GlossyWalls box({tests::make_cube(1, true)}, gloss, {1, 1, 1});
            const GlossyWalls wall({tests::make_quad({0, -40, -40}, {0, 80, 0}, {0, 0, 80})}, gloss,
                                   {1, 1, 1});
            for (const std::uint32_t rays : {16u, 64u, 1024u}) {
                const double in_box = shares_of_rays(box, {{0.3f, -0.99f, 0.2f}, {0, 1, 0}}, rays);
                const double before_wall = shares_of_rays(wall, {{1e-3f, 0, 0}, {0, 1, 0}}, rays);
                for (const double sum : {in_box, before_wall}) {
                    EXPECT_NEAR(sum, 1, gloss.metallic > 0 ? 0.02 : 1e-4)
                        << roughness << " " << gloss.metallic << " " << rays;
                    EXPECT_LT(sum, 1 + 1e-5);
                }
            }
        }
    }
}

TEST(NarrowLobe, BroadLobesAndThoseThatThePlanLeavesOutMirrorNothingHere) {
    GlossyWalls plate({tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})},
                      {.metallic = 1, .roughness = 0.2f}, {1, 1, 1});
    const RayEnd end{.direction = {0, -1, 0}, .side = {true, false, {0, 1, 0}, 1}};
    EXPECT_NEAR(mirror(plate.space(), end, {1, 1, 1}, 0).share.g, 1, 0.01);
    plate.scene.materials[0].gloss.roughness = kBroadLobe;
    EXPECT_EQ(mirror(plate.space(), end, {1, 1, 1}, 0).largest(), 0);
    plate.scene.materials[0].gloss.roughness = 0.2f;
    plate.layouts[0].mirrors = false;
    EXPECT_EQ(mirror(plate.space(), end, {1, 1, 1}, 0).largest(), 0);
}

}  // namespace
}  // namespace opaline::bake
