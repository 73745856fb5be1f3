#include <gmock/gmock.h>

#include <algorithm>

#include "formats/media/apply_media.h"
#include "formats/media/presets.h"
#include "formats/media/read_media.h"
#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::Medium;
using formats::PhaseFunction;
using formats::Rgb;
using ::testing::ElementsAre;

void expect_close(Rgb found, Rgb expected) {
    EXPECT_FLOAT_EQ(found.r, expected.r);
    EXPECT_FLOAT_EQ(found.g, expected.g);
    EXPECT_FLOAT_EQ(found.b, expected.b);
}

TEST(ReadMedia, EveryKeyOfACustomMediumArrives) {
    const Medium medium = medium_of(R"("sigma_s": [1, 2, 3], "sigma_a": [0.1, 0, 0.3],
        "unit": "1/m", "phase": {"type": "hg", "g": 0.3}, "eta": 1.44, "roughness": 0.5,
        "profile": "beams", "fidelity": "paper")");
    EXPECT_EQ(medium.sigma_s, (Rgb{1, 2, 3}));
    EXPECT_EQ(medium.sigma_a, (Rgb{0.1f, 0, 0.3f}));
    EXPECT_EQ(medium.phase.type, PhaseFunction::Type::henyey_greenstein);
    EXPECT_EQ(medium.phase.g, 0.3f);
    EXPECT_EQ(medium.eta, 1.44f);
    EXPECT_EQ(medium.roughness, 0.5f);
    EXPECT_EQ(medium.profile, Medium::Profile::beams);
    EXPECT_EQ(medium.fidelity, Medium::Fidelity::paper);
}

TEST(ReadMedia, UnitIsPerMillimetreUnlessItSaysPerMetre) {
    const std::string entry = R"("sigma_s": [1, 2, 3], "sigma_a": [4, 5, 6])";
    const Medium plain = medium_of(entry), mm = medium_of(entry + R"(, "unit": "1/mm")"),
                 m = medium_of(entry + R"(, "unit": "1/m")");
    expect_close(plain.sigma_s, 1000.0f * m.sigma_s);
    expect_close(plain.sigma_a, 1000.0f * m.sigma_a);
    EXPECT_EQ(plain.sigma_s, mm.sigma_s);
}

TEST(ReadMedia, ReducedScatteringIsDividedByOneLessG) {
    // sigma_s' = (1 - g) sigma_s: 3 = (1 - 0.25) 4 and 5 = (1 + 0.25) 4.
    for (const auto& [reduced, g] : {std::pair{"3", "0.25"}, std::pair{"5", "-0.25"}}) {
        const std::string band(reduced);
        expect_close(medium_of("\"sigma_s_prime\": [" + band + "," + band + "," + band +
                               R"(], "sigma_a": [0, 0, 0], "unit": "1/m",
                                  "phase": {"type": "hg", "g": )" +
                               g + "}")
                         .sigma_s,
                     {4, 4, 4});
    }
    const Medium isotropic = medium_of(R"("sigma_s_prime": [3, 3, 3], "sigma_a": [0, 0, 0])");
    EXPECT_EQ(isotropic.sigma_s, (Rgb{3000, 3000, 3000}));
}

TEST(ReadMedia, PresetIsReducedScatteringToo) {
    const Medium preset = *formats::media_preset("marble");
    EXPECT_EQ(medium_of(R"("preset": "marble")").sigma_s, preset.sigma_s);
    const Medium forward = medium_of(R"("preset": "marble", "phase": {"type": "hg", "g": 0.5})");
    expect_close(forward.sigma_s, 2.0f * preset.sigma_s);
    EXPECT_EQ(forward.sigma_a, preset.sigma_a);
    EXPECT_EQ(forward.eta, 1.5f);
    EXPECT_EQ(medium_of(R"("preset": "marble", "eta": 1.2)").eta, 1.2f);
}

TEST(ReadMedia, EveryPhaseTypeIsRead) {
    const std::string coefficients = R"("sigma_s": [1, 1, 1], "sigma_a": [0, 0, 0], "phase": )";
    using Type = PhaseFunction::Type;
    const auto type_of = [&](const std::string& phase) {
        return medium_of(coefficients + phase).phase.type;
    };
    EXPECT_EQ(type_of(R"({"type": "isotropic"})"), Type::isotropic);
    EXPECT_EQ(type_of(R"({"type": "rayleigh"})"), Type::rayleigh);
    EXPECT_EQ(type_of(R"({"type": "hg", "g": -0.99})"), Type::henyey_greenstein);
    EXPECT_EQ(type_of(R"({"type": "gaussian", "rms_angle": 0.11})"), Type::gaussian);
}

TEST(ReadMedia, EveryProfileIsRead) {
    using Profile = Medium::Profile;
    const auto profile = [](const std::string& name) {
        return medium_of(R"("preset": "skin1", "profile": ")" + name + "\"").profile;
    };
    EXPECT_EQ(profile("auto"), Profile::automatic);
    EXPECT_EQ(profile("classic"), Profile::classic);
    EXPECT_EQ(profile("better"), Profile::better);
    EXPECT_EQ(profile("beams"), Profile::beams);
    EXPECT_EQ(profile("normalized"), Profile::normalized);
}

TEST(ReadMedia, OpaqueHasNoMediumAndBaseColourIsKept) {
    const auto media = read_text_as_media(
        R"({"materials": {"A": {"opaque": true, "base_color": [0.5, 0, 1]},
                          "*": {"preset": "cream", "opaque": false}}})");
    ASSERT_TRUE(media.has_value()) << faults(media);
    ASSERT_EQ(media->materials.size(), 2u);
    EXPECT_EQ(media->materials[0].name, "*");
    EXPECT_TRUE(media->materials[0].medium.has_value());
    EXPECT_FALSE(media->materials[0].base_color.has_value());
    EXPECT_FALSE(media->materials[1].medium.has_value());
    EXPECT_EQ(media->materials[1].base_color, (Rgb{0.5f, 0, 1}));
}

TEST(ReadMedia, PureAbsorberIsAMedium) {
    EXPECT_EQ(medium_of(R"("sigma_s": [0, 0, 0], "sigma_a": [0, 1, 0])").sigma_a,
              (Rgb{0, 1000, 0}));
}

TEST(ReadMedia, FilesReadAreListedAndHashed) {
    const TemporaryFolder folder;
    const std::string text = wax(R"("preset": "skin1", "phase": {"type": "table",
                                     "file": "tables/a.csv"})");
    std::filesystem::create_directory(folder / "tables");
    write_text(folder / "media.json", text);
    write_text(folder / "tables/a.csv", "-1 1\n1 1\n");
    const auto first = formats::read_media(folder / "media.json");
    ASSERT_TRUE(first.has_value()) << faults(first);
    EXPECT_THAT(first->inputs, ElementsAre(folder / "media.json", folder / "tables/a.csv"));
    EXPECT_EQ(first->sha256.size(), 64u);
    EXPECT_EQ(first->materials.at(0).medium->phase.type, PhaseFunction::Type::tabulated);
    write_text(folder / "tables/a.csv", "-1 1\n1 2\n");
    const auto second = formats::read_media(folder / "media.json");
    ASSERT_TRUE(second.has_value()) << faults(second);
    EXPECT_NE(second->sha256, first->sha256);
}

TEST(ReadMedia, TheSameObjectIsReadFromInsideAnotherFile) {
    const TemporaryFolder folder;
    write_text(folder / "table.csv", "-1 1\n1 1\n");
    const auto media = formats::parse_media(
        wax(R"("preset": "skin1", "phase": {"type": "table", "file": "table.csv"})"),
        folder / "scene.gltf", "extensions > OPALINE_media");
    ASSERT_TRUE(media.has_value()) << faults(media);
    EXPECT_THAT(media->inputs, ElementsAre(folder / "table.csv"));
    const auto bad = formats::parse_media(wax("\"eta\": 9"), folder / "scene.gltf",
                                          "extensions > OPALINE_media");
    EXPECT_THAT(faults(bad), ::testing::HasSubstr("extensions > OPALINE_media > materials > Wax"));
}

TEST(ReadMedia, MarbleHasDefaultsOfVeinedStone) {
    const auto media = read_text_as_media(wax(R"("preset": "marble", "marble": {})"));
    ASSERT_TRUE(media.has_value()) << faults(media);
    ASSERT_TRUE(media->materials.at(0).marble.has_value());
    const formats::Marble& marble = *media->materials[0].marble;
    EXPECT_EQ(marble.scale, 0.04f);
    EXPECT_LT(luminance(marble.colors.front()), luminance(marble.colors.back()));
    EXPECT_EQ(marble.colors.back(), (Rgb{1, 1, 1}));
}

TEST(ReadMedia, MarbleInsideBelongsToTheMediumAndNotToTheLightThatLeaves) {
    const auto media =
        read_text_as_media(wax(R"("preset": "marble", "phase": {"type": "hg", "g": 0.25},
               "marble": {"scale": 2, "inside": true})"));
    ASSERT_TRUE(media.has_value()) << faults(media);
    EXPECT_FALSE(media->materials.at(0).marble);
    ASSERT_TRUE(media->materials[0].medium->variation);
    const formats::Variation& variation = *media->materials[0].medium->variation;
    ASSERT_TRUE(variation.marble);
    EXPECT_EQ(variation.marble->scale, 2.0f);
    EXPECT_EQ(variation.g, 0.25f);
    EXPECT_FALSE(medium_of(R"("preset": "marble", "marble": {"inside": false})").variation);
}

TEST(ReadMedia, MarbleTakesScaleAndColoursOfTheFile) {
    const auto media = read_text_as_media(
        wax(R"("opaque": true, "marble": {"scale": 2, "colors": [[0, 0.5, 1], [1, 0, 0]]})"));
    ASSERT_TRUE(media.has_value()) << faults(media);
    const formats::Marble& marble = media->materials.at(0).marble.value();
    EXPECT_EQ(marble.scale, 2.0f);
    EXPECT_EQ(marble.colors, (std::vector<Rgb>{{0, 0.5f, 1}, {1, 0, 0}}));
}

using formats::media_preset;
using formats::media_preset_names;

TEST(MediaPresets, AllTwelveMeasuredMediaAreThereAndSound) {
    ASSERT_EQ(media_preset_names().size(), 12u);
    EXPECT_TRUE(std::is_sorted(media_preset_names().begin(), media_preset_names().end()));
    for (const std::string_view name : media_preset_names()) {
        const auto medium = media_preset(name);
        ASSERT_TRUE(medium.has_value()) << name;
        EXPECT_TRUE(is_sound(*medium)) << name;
        EXPECT_EQ(medium->phase.type, PhaseFunction::Type::isotropic) << name;
        EXPECT_EQ(medium->eta, name == "marble" ? 1.5f : 1.3f) << name;
    }
}

TEST(MediaPresets, SkimMilkHasTwoSpellingsAndOtherNamesAreUnknown) {
    EXPECT_EQ(media_preset("skimmilk")->sigma_s, media_preset("skim-milk")->sigma_s);
    for (const char* name : {"", "Marble", "milk", "skin3"}) {
        EXPECT_FALSE(media_preset(name).has_value()) << name;
    }
}

using ::testing::HasSubstr;

std::string refuse_groups(const std::string& emitters) {
    const auto media = read_text_as_media("{\"emitters\": " + emitters + "}");
    EXPECT_FALSE(media.has_value()) << emitters;
    return faults(media);
}

TEST(EmitterGroups, AreReadWithoutMaterialsAndReplaceThoseOfTheScene) {
    const auto media = read_text_as_media(
        R"-({"emitters": {"Ceiling": ["Lamp", "Lamp (2)"], "Sun": "light 3"}})-");
    ASSERT_TRUE(media.has_value()) << faults(media);
    formats::Scene scene;
    scene.materials.emplace_back();
    scene.emitter_groups = {{"Old", {"Lamp"}}};
    ASSERT_TRUE(formats::apply_media(*media, scene));
    ASSERT_EQ(scene.emitter_groups.size(), 2u);
    EXPECT_EQ(scene.emitter_groups[0].name, "Ceiling");
    EXPECT_THAT(scene.emitter_groups[0].members, ElementsAre("Lamp", "Lamp (2)"));
    EXPECT_THAT(scene.emitter_groups[1].members, ElementsAre("light 3"));

    const auto other = read_text_as_media(R"({"materials": {}})");
    ASSERT_TRUE(other.has_value()) << faults(other);
    ASSERT_TRUE(formats::apply_media(*other, scene));
    EXPECT_EQ(scene.emitter_groups.size(), 2u);
}

TEST(EmitterGroups, WhatCannotBeIsNamedWithItsPlace) {
    EXPECT_THAT(refuse_groups("[]"), HasSubstr("emitters: it is not an object"));
    EXPECT_THAT(refuse_groups(R"({"A": []})"), HasSubstr("emitters > A"));
    EXPECT_THAT(refuse_groups(R"({"A": [1]})"), HasSubstr("a list of 1 to 4096 texts"));
    EXPECT_THAT(refuse_groups(R"({"": ["x"]})"), HasSubstr("a group's name is empty"));
    EXPECT_THAT(refuse_groups(R"({"a\u0007": ["x"]})"), HasSubstr("control characters"));
    EXPECT_THAT(refuse_groups("{\"" + std::string(256, 'a') + R"(": ["x"]})"),
                HasSubstr("255 bytes"));
    EXPECT_THAT(refuse_groups(R"({"A": ["x", "x"]})"),
                HasSubstr("emitters > A: the emitter 'x' is in the group 'A' already"));
    EXPECT_THAT(refuse_groups(R"({"A": ["x"], "B": ["y", "x"]})"),
                HasSubstr("emitters > B: the emitter 'x' is in the group 'A' already"));
}

}  // namespace

}  // namespace opaline::tests
