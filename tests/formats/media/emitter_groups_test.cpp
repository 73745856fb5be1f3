#include "formats/media/apply_media.h"
#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using ::testing::ElementsAre;
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
