// What an emitter is, and what it sends out.
#include "bake/exchange/lamps/lamps.h"

#include <gmock/gmock.h>

#include "formats/opal/emitters.h"
#include "tests/bake/lamps/lamp_scenes.h"

namespace opaline::bake {
namespace {

using formats::Light;

formats::Scene glowing_quads(std::initializer_list<const char*> names) {
    formats::Scene scene;
    for (const char* name : names) {
        tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.5f, 1);
        scene.primitives.back().name = name;
    }
    return scene;
}

TEST(Lamps, AreNodesWhoseSurfacesGlowAndLightsByName) {
    formats::Scene scene =
        glowing_quads({"node 'Panel' > mesh 0 > primitive 0", "node 'Panel' > mesh 0 > primitive 1",
                       "node 'Panel' > mesh 0 > primitive 0", "node 7 > mesh 1"});
    scene.primitives[1].node = scene.primitives[0].node;
    scene.materials[1].emission = {0, 2, 0};
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0.5f);
    scene.lights.push_back({.name = "Bulb"});
    scene.lights.push_back({.name = "Off", .intensity = {0, 0, 0}});
    scene.lights.push_back({});
    const std::vector<Lamp> lamps = list_lamps(scene);
    ASSERT_EQ(lamps.size(), 5u);
    EXPECT_EQ(lamps[0].name, "Panel");
    EXPECT_EQ(lamps[0].primitives, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(lamps[1].name, "Panel (2)");
    EXPECT_EQ(lamps[2].name, "node 7");
    EXPECT_EQ(lamps[3].name, "Bulb");
    EXPECT_EQ(lamps[3].lights, (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(lamps[4].name, "light 2");
}

TEST(Lamps, NamesFitIntoAFileAtWholeCharacters) {
    std::string name = "node 'a";
    for (int i = 0; i < 200; ++i)
        name += "\xc3\xa4";
    const std::vector<Lamp> lamps = list_lamps(glowing_quads({(name + "\n'").c_str()}));
    EXPECT_LE(lamps[0].name.size(), formats::kMaxEmitterName);
    EXPECT_EQ(lamps[0].name.back(), '\xa4');
    EXPECT_EQ(lamps[0].name.find('\n'), std::string::npos);
}

TEST(Lamps, MoreThanAFileHoldsAreRefused) {
    EXPECT_TRUE(check_lamps({}, formats::kMaxEmitters, "emitters"));
    const auto status = check_lamps({}, formats::kMaxEmitters + 1, "emitters");
    ASSERT_FALSE(status);
    EXPECT_THAT(status.error().diagnostics.front().fault,
                testing::HasSubstr("65 nodes and lights"));
}

// A panel of two nodes, a lamp, a bulb.
formats::Scene grouped_scene(std::vector<formats::EmitterGroup> groups) {
    formats::Scene scene = glowing_quads({"node 'Panel'", "node 'Lamp'", "node 'Panel'"});
    for (std::uint32_t p = 0; p < 3; ++p)
        scene.primitives[p].node = p;
    scene.lights.push_back({.name = "Bulb"});
    scene.emitter_groups = std::move(groups);
    return scene;
}

TEST(Lamps, ThoseOfAGroupAreOneInThePlaceOfItsFirst) {
    const formats::Scene scene =
        grouped_scene({{"Ceiling", {"Bulb", "Panel", "Panel (2)"}}, {"Panel", {"Lamp"}}});
    EXPECT_TRUE(check_lamps(scene, 2, "emitters"));
    const std::vector<Lamp> lamps = list_lamps(scene);
    ASSERT_EQ(lamps.size(), 2u);
    EXPECT_EQ(lamps[0].name, "Ceiling");
    EXPECT_EQ(lamps[0].primitives, (std::vector<std::uint32_t>{0, 2}));
    EXPECT_EQ(lamps[0].lights, (std::vector<std::uint32_t>{0}));
    EXPECT_EQ(lamps[1].name, "Panel");
    EXPECT_EQ(lamps[1].primitives, (std::vector<std::uint32_t>{1}));
    EXPECT_EQ(make_lamp_sources(scene, lamps[0]).triangles.size(), 4u);
}

TEST(Lamps, AGroupOfWhatIsNotThereOrOfATakenNameIsRefused) {
    const auto error_of = [](std::vector<formats::EmitterGroup> groups) {
        const auto status = check_lamps(grouped_scene(std::move(groups)), 3, "emitters");
        return status ? formats::Diagnostic{} : status.error().diagnostics.front();
    };
    const formats::Diagnostic unknown = error_of({{"Ceiling", {"Lmap"}}});
    EXPECT_EQ(unknown.where, "media > emitters > Ceiling");
    EXPECT_EQ(unknown.fault, "there is no emitter 'Lmap'");
    EXPECT_EQ(unknown.remedy, "the scene has: 'Panel', 'Lamp', 'Panel (2)', 'Bulb'");
    EXPECT_THAT(error_of({{"Lamp", {"Bulb"}}}).fault, testing::HasSubstr("has this name already"));
}

TEST(LampSources, PowerIsPiAreaRadianceOfASide) {
    formats::Scene scene = glowing_quads({"a"});
    LampSources sources = make_lamp_sources(scene, list_lamps(scene)[0]);
    ASSERT_EQ(sources.triangles.size(), 2u);
    EXPECT_NEAR(sources.triangles[0].power().x + sources.triangles[1].power().x, std::numbers::pi,
                1e-12);
    scene.materials[0].double_sided = true;
    sources = make_lamp_sources(scene, list_lamps(scene)[0]);
    EXPECT_NEAR(sources.triangles[0].power().x, std::numbers::pi, 1e-12);
}

TEST(LampSources, PowerOfLights) {
    formats::Scene scene = glowing_quads({"a"});
    LampSources sources = make_lamp_sources(scene, list_lamps(scene)[0]);
    Light light{.name = "", .intensity = {1, 2, 3}};
    EXPECT_NEAR(light_power(sources, light).y, 8 * std::numbers::pi, 1e-5);
    light.type = Light::Type::directional;
    EXPECT_NEAR(light_power(sources, light).z, 3 * 2.0, 1e-5);  // a square of side sqrt 2
}

}  // namespace
}  // namespace opaline::bake
