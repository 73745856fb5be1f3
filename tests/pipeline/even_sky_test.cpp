// Several things that absorb nothing, under an even sky: energy is neither created nor lost between
// them, so everything shows what the sky shows.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/scene/lobe_record.h"
#include "tests/support/media_bake.h"
#include "tests/support/volumes.h"

namespace opaline::bake {
namespace {

enum class Thing : std::uint8_t { floor, wall, block, shell, dense_block, smoke, metal, coat };
constexpr std::array kThings{Thing::floor, Thing::wall,        Thing::block,
                             Thing::shell, Thing::dense_block, Thing::smoke};
constexpr std::array kGlossy{Thing::metal, Thing::coat};
constexpr std::array<const char*, kThings.size() + kGlossy.size()> kNames{
    "Floor", "ThinWall", "Block", "Shell", "DenseBlock", "Smoke", "Metal", "Coat"};

// Within 1.1 of a place.
void add(Thing thing, glm::vec3 at, formats::Scene& scene) {
    formats::Material material{.name = kNames[static_cast<std::size_t>(thing)]};
    material.base_color = {1, 1, 1};
    std::vector<tests::Primitive> made;
    switch (thing) {
        case Thing::floor:
            made.push_back(tests::make_quad({-1.1f, -1.1f, -1.1f}, {0, 0, 2.2f}, {2.2f, 0, 0}, 5));
            break;
        case Thing::wall:
            made.push_back(tests::make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 5));
            material.sheet =
                formats::Sheet{.reflect = {.6f, .6f, .6f}, .transmit = {.4f, .4f, .4f}};
            break;
        case Thing::block:
            made.push_back(tests::make_cube(3, false));
            material.medium = tests::make_grey_medium(3, 0, 1.3f);
            break;
        case Thing::dense_block:
            made.push_back(tests::make_cube(3, false));
            material.medium = tests::make_grey_medium(30, 0, 1.5f);
            break;
        case Thing::shell:
            made.push_back(tests::make_sphere(2));
            made.push_back(tests::turned_inside_out(tests::make_sphere(2, 0.8f)));
            material.medium = tests::make_grey_medium(50, 0, 1.5f);
            break;
        case Thing::metal:
            made.push_back(tests::make_sphere(3));
            material.gloss = {.metallic = 1, .roughness = 0.1f};
            break;
        case Thing::coat:
            made.push_back(tests::make_quad({-1.1f, -1.1f, -1.1f}, {0, 0, 2.2f}, {2.2f, 0, 0}, 5));
            material.gloss = {.roughness = 0.3f, .specular = 1, .ior = 2};
            break;
        case Thing::smoke: {
            formats::Volume volume = tests::make_volume(tests::make_blob(0.3, 0.1), 1.5f, 1, 0);
            volume.density.to_scene =
                glm::translate(glm::dmat4(1), glm::dvec3(at)) * volume.density.to_scene;
            scene.volumes.push_back(std::move(volume));
            return;
        }
    }
    for (tests::Primitive& primitive : made) {
        primitive = tests::transformed(std::move(primitive), glm::mat3(1), 1, at);
        primitive.material = static_cast<std::uint32_t>(scene.materials.size());
        scene.primitives.push_back(std::move(primitive));
    }
    scene.materials.push_back(material);
}

// What a view along the normal sees of the sky besides the lobe: nothing of a metal.
float share_below_lobe(const formats::Material& material) {
    if (material.medium || material.gloss.is_diffuse()) return 1;
    return formats::eval_gloss_albedo(
               formats::make_gloss_surface(make_lobe_record(material.gloss), {1, 1, 1},
                                           material.gloss.metallic, material.gloss.roughness),
               1)
        .diffuse;
}

class EvenSky : public testing::TestWithParam<std::vector<Thing>> {};

TEST_P(EvenSky, EverythingThatAbsorbsNothingShowsTheSky) {
    constexpr std::array<glm::vec3, 3> kPlaces{{{0, 0, 0}, {2.3f, 0, 0}, {1.1f, 0.3f, 2.3f}}};
    formats::Scene scene;
    scene.source = "test scene";
    for (std::size_t i = 0; i < GetParam().size(); ++i) {
        add(GetParam()[i], kPlaces[i], scene);
    }
    BakeOptions options;
    options.quality = Quality::draft;
    options.cubemap_size = 8;
    options.set(kSamples, 1000);
    options.set(kWalks, 100000);
    options.set(kSites, 600);
    options.threads = 2;
    const BakeResult baked = tests::bake_scene(scene, options);
    std::vector<formats::Rgb> shown;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const float share = share_below_lobe(scene.materials[scene.primitives[p].material]);
        if (share == 0) continue;
        for (formats::Rgb& c : tests::relight_primitive(baked.asset, "white", p)) {
            shown.push_back(1 / share * c);
        }
    }
    double mean = 0, square = 0;
    for (const formats::Rgb& c : shown) {
        mean += double{c.g} / static_cast<double>(shown.size());
        square += (double{c.g} - 1) * (double{c.g} - 1) / static_cast<double>(shown.size());
    }
    // No primitive may shine: what is lost is stated, what is created has no excuse but noise.
    constexpr double kNoise = 0.03;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const float share = share_below_lobe(scene.materials[scene.primitives[p].material]);
        EXPECT_LE(tests::mean_green(tests::relight_primitive(baked.asset, "white", p)),
                  (1 + kNoise) * share)
            << scene.materials[scene.primitives[p].material].name;
    }
    // Stated under six lights; at the few receivers of so small a bake it is known to a third.
    constexpr double kKnown = 1.3;
    std::printf("mean %.3f, RMS %.3f, stated %.3f\n", mean, std::sqrt(square),
                baked.error.rms_relative);
    // Shells lose .022 by themselves, which so few receivers may not see.
    const double stated = std::max(baked.error.rms_relative, 0.025);
    EXPECT_LT(std::sqrt(square), kKnown * stated);
    EXPECT_LT(std::abs(mean - 1), stated);
    EXPECT_LT(baked.error.rms_relative, 0.15);
}

std::vector<std::vector<Thing>> pairs() {
    std::vector<std::vector<Thing>> all;
    for (const Thing a : kThings) {
        for (const Thing b : kThings) {
            if (a <= b && !(a == Thing::smoke && b == Thing::smoke)) all.push_back({a, b});
        }
    }
    for (const Thing b : kGlossy) {
        for (const Thing a : kThings) {
            if (a != Thing::smoke || b != Thing::metal) all.push_back({a, b});
        }
    }
    all.push_back({Thing::metal, Thing::coat});
    return all;
}

std::vector<std::vector<Thing>> triples() {
    std::vector<std::vector<Thing>> all;
    for (const std::vector<Thing>& pair : pairs()) {
        for (const Thing c : kThings) {
            if (pair[0] < pair[1] && pair[1] < c && pair[1] < Thing::metal)
                all.push_back({pair[0], pair[1], c});
        }
    }
    return all;
}

std::string name_of(const testing::TestParamInfo<std::vector<Thing>>& info) {
    std::string name;
    for (const Thing thing : info.param) {
        name += kNames[static_cast<std::size_t>(thing)];
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(Pairs, EvenSky, testing::ValuesIn(pairs()), name_of);
INSTANTIATE_TEST_SUITE_P(Triples, EvenSky, testing::ValuesIn(triples()), name_of);

// Light does not cross air by diffusion: samples of the other cube, a tenth of an edge away, lit
// the faces in the gap up to 1.34. Light that arrives from the other cube and scatters once is not
// lost.
TEST(EvenSkyOfTheDipole, TwoCubesOfOneMediumShowTheSkyInTheGapBetweenThem) {
    formats::Scene scene =
        tests::make_translucent_scene({tests::make_cube(6, false), tests::make_cube(6, false)},
                                      tests::make_grey_medium(20, 0, 1.3f));
    for (glm::vec3& p : scene.primitives[1].position) {
        p.x += 2.2f;
    }
    BakeOptions options;
    options.quality = Quality::draft;
    options.threads = 2;
    options.set(kMultipleModel, static_cast<double>(MultipleModel::dipole));
    const BakeResult baked = tests::bake_scene(scene, options);
    const auto shown = tests::relight_primitive(baked.asset, "white", 0);
    double in_gap = 0, count = 0;
    for (std::size_t v = 0; v < shown.size(); ++v) {
        EXPECT_LT(shown[v].g, 1.12f);
        if (scene.primitives[0].normal[v].x < 0.9f) continue;
        in_gap += double{shown[v].g};
        count += 1;
    }
    EXPECT_NEAR(in_gap / count, 0.93, 0.04) << "edges, of which half is beyond, are darker";
}

}  // namespace
}  // namespace opaline::bake
