// The bytes of a file depend neither on the number of threads nor on which of them does what. The
// loops that all stages share have tests of their own (tests/bake/base); here whole bakes, of
// scenes that hold every kind of thing, are compared.
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "bake/check/check_model.h"
#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/interreflection/interreflection.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/write_opal.h"
#include "tests/bake/walks/nested_bodies.h"
#include "tests/support/media_bake.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/varied_media.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

// Adds a primitive with a material of its own, and returns that.
formats::Material& add(Scene& scene, Primitive primitive, const char* name) {
    primitive.name = name;
    primitive.node = static_cast<std::uint32_t>(scene.primitives.size());
    primitive.material = static_cast<std::uint32_t>(scene.materials.size());
    scene.primitives.push_back(std::move(primitive));
    scene.materials.push_back({.name = name});
    return scene.materials.back();
}

// Opaque, glossy, thin-walled and translucent things and a lamp on a floor, beneath smoke that
// glows.
Scene make_things() {
    Scene scene;
    scene.source = "things";
    add(scene, make_quad({-2, -0.5f, -2}, {0, 0, 4}, {4, 0, 0}, 2), "floor");
    add(scene, make_sphere(1, 0.4f, {-1, 0, 0}), "metal").gloss = {.metallic = 1,
                                                                   .roughness = 0.4f};
    add(scene, make_quad({0.8f, -0.5f, -0.5f}, {0, 1, 0}, {0, 0, 1}, 2), "paper").sheet =
        formats::Sheet{{0.4f, 0.4f, 0.3f}, {0.3f, 0.2f, 0.1f}};
    formats::Medium wax = make_grey_medium(40, 1);
    wax.sigma_s.b = 90;
    wax.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.3f, 0, {}, {}};
    add(scene, make_sphere(2, 0.4f, {0, 0, 0.2f}), "wax").medium = wax;
    add(scene, make_sphere(1, 0.3f, {0, 0, -1}), "glass").medium = make_grey_medium(0, 0.5f, 1.5f);
    add(scene, make_quad({-0.2f, 1.5f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, 1), "lamp").emission = {
        9, 7, 5};
    scene.volumes.push_back(make_volume(make_ball_grid(0.4, 0.2), 3, 0.8f, 0.5f));
    scene.volumes[0].density.to_scene[3] = glm::dvec4(1, 0.7, 0, 1);
    make_it_glow(scene.volumes[0], {2, 1, 0});
    return scene;
}

// A veined body and one with a core.
Scene make_inner_things() {
    Scene scene = make_nested_scene({{make_sphere(1), make_grey_medium(4, 0.2f)},
                                     {make_sphere(1, 0.6f), make_grey_medium(20, 1, 1.5f)}});
    Primitive veined = make_sphere(1, 0.5f, {2, 0, 0});
    map_along_x(veined);
    formats::Material& material = add(scene, std::move(veined), "veined");
    material.medium = make_grey_medium(8, 0.2f);
    material.medium->variation.emplace();
    const formats::InnerTexture rising = add_inner_texture(scene, make_rising_image());
    scene.materials.back().medium->variation->density = rising;
    return scene;
}

std::string file_of(const Scene& scene, bake::BakeOptions options, unsigned threads) {
    options.threads = threads;
    bake::BakeResult result = bake_scene(scene, options);
    const TemporaryFolder folder;
    auto file = formats::AtomicFile::create(folder / "a.opal");
    EXPECT_TRUE(file && formats::write_opal(result.asset.view(), std::move(*file)));
    const auto bytes = formats::FileBytes::open(folder / "a.opal").value();
    return {reinterpret_cast<const char*>(bytes.bytes().data()), bytes.bytes().size()};
}

void expect_same_bytes(const Scene& scene, const bake::BakeOptions& options) {
    const std::string one = file_of(scene, options, 1);
    EXPECT_TRUE(file_of(scene, options, 3) == one);
}

bake::BakeOptions by(bake::MultipleModel model) {
    bake::BakeOptions options = small_bake();
    options.quality = bake::Quality::draft;
    options.coefficients = 32;
    options.set(bake::kMultipleModel, static_cast<double>(model));
    for (const auto& [knob, few] : {std::pair(&bake::kWalks, 1000),
                                    {&bake::kSites, 500},
                                    {&bake::kSamples, 100},
                                    {&bake::kBounceRays, 16},
                                    {&bake::kEmitterParticles, 1000},
                                    {&bake::kEmitterRays, 16},
                                    {&bake::kVolumeWalks, 4},
                                    {&bake::kVolumeCoefficients, 64}}) {
        options.set(*knob, few);
    }
    return options;
}

TEST(Threads, DoNotChangeAByteOfAFileWithEveryKindOfThingByWalks) {
    expect_same_bytes(make_things(), by(bake::MultipleModel::walks));
}

TEST(Threads, DoNotChangeAByteOfAFileWithEveryKindOfThingByTheDipole) {
    Scene scene = make_things();
    scene.volumes.clear();
    expect_same_bytes(scene, by(bake::MultipleModel::dipole));
}

TEST(Threads, DoNotChangeAByteOfAFileOfMediaThatVaryInside) {
    expect_same_bytes(make_inner_things(), by(bake::MultipleModel::automatic));
}

TEST(Threads, DoNotChangeAByteOfAFileThatMeetsATargetError) {
    bake::BakeOptions options;
    options.error = 0.2;
    expect_same_bytes(make_translucent_scene({make_sphere(1)}, make_grey_medium(4, 0.02f)),
                      options);
}

TEST(Threads, DoNotChangeADigitOfTheModelError) {
    const Scene scene = make_ball_on_floor(make_grey_medium(40, 2));
    const bake::BakeResult baked = bake_scene(scene, small_bake());
    bake::ModelCheckOptions wanted;
    wanted.receivers = 48;
    wanted.max_events = 30000;
    bake::Context one, three;
    one.threads = 1, three.threads = 3;
    const auto a = bake::check_model(scene, baked.asset.view(), wanted, one).value();
    const auto b = bake::check_model(scene, baked.asset.view(), wanted, three).value();
    EXPECT_EQ(a.rms_relative, b.rms_relative);
    EXPECT_EQ(a.ci95[1], b.ci95[1]);
    EXPECT_EQ(a.missing, b.missing);
    ASSERT_TRUE(a.suns && b.suns);
    EXPECT_EQ(a.suns->rms_relative, b.suns->rms_relative);
}

}  // namespace
}  // namespace opaline::tests
