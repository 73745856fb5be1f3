#include "formats/media/apply_media.h"

#include "tests/formats/media/media_text.h"

namespace opaline::tests {
namespace {

using formats::apply_media;
using formats::Medium;
using formats::Rgb;
using formats::Scene;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Its warnings; expects success.
std::vector<formats::Diagnostic> apply(const formats::MediaFile& media, Scene& scene) {
    const auto warnings = apply_media(media, scene);
    EXPECT_TRUE(warnings.has_value());
    return warnings ? *warnings : std::vector<formats::Diagnostic>{};
}

Scene scene_of(const std::vector<std::string>& names) {
    Scene scene;
    scene.sha256 = std::string(64, 'a');
    scene.inputs = {"scene.glb"};
    for (const std::string& name : names) {
        scene.materials.emplace_back().name = name;
    }
    return scene;
}

formats::MediaFile media_of(const std::string& materials) {
    const auto media = read_text_as_media("{\"materials\": {" + materials + "}}");
    EXPECT_TRUE(media.has_value()) << faults(media);
    return media ? *media : formats::MediaFile{};
}

TEST(ApplyMedia, MatchesByNameAndStarTakesTheOthers) {
    Scene scene = scene_of({"Body", "Eye", "Floor", ""});
    const auto warnings = apply(media_of(R"("Body": {"preset": "marble"}, "Floor": {"opaque": true},
                    "*": {"preset": "skin1"})"),
                                scene);
    EXPECT_TRUE(warnings.empty());
    EXPECT_EQ(scene.materials[0].medium->eta, 1.5f);
    EXPECT_EQ(scene.materials[1].medium->eta, 1.3f);
    EXPECT_FALSE(scene.materials[2].medium.has_value());
    EXPECT_EQ(scene.materials[3].medium->eta, 1.3f);
}

TEST(ApplyMedia, WithoutStarTheOthersStayAndWhatIsNamedIsReplacedEachTime) {
    Scene scene = scene_of({"Body", "Glass", "Pane", "Body"});
    scene.materials[0].medium = scene.materials[1].medium = scene.materials[2].medium = Medium{};
    scene.materials[1].medium->eta = 1.7f;
    EXPECT_TRUE(apply(media_of(R"("Body": {"preset": "marble"}, "Pane": {"opaque": true})"), scene)
                    .empty());
    EXPECT_EQ(scene.materials[0].medium->eta, 1.5f);
    EXPECT_EQ(scene.materials[1].medium->eta, 1.7f);
    EXPECT_FALSE(scene.materials[2].medium.has_value());
    EXPECT_TRUE(scene.materials[3].medium.has_value()) << "of the same name";
}

// Of a thin-walled surface nothing stays, neither its colour nor its second side.
TEST(ApplyMedia, WhatReplacesAThinWalledSurfaceFindsTheMaterialAsItWas) {
    Scene scene = scene_of({"Leaf", "Body"});
    for (formats::Material& material : scene.materials) {
        material.sheet = formats::Sheet{
            .reflect = {1, 1, 1}, .transmit = {0.5f, 1, 1}, .opaque_color = {0.1f, 0.2f, 0.3f}};
        material.base_color = {0.2f, 0.2f, 0.3f};
        material.double_sided = true;
    }
    (void)apply(media_of(R"("Leaf": {"opaque": true}, "Body": {"preset": "marble"})"), scene);
    EXPECT_EQ(scene.materials[0].base_color, (formats::Rgb{0.1f, 0.2f, 0.3f}));
    for (const formats::Material& material : scene.materials) {
        EXPECT_FALSE(material.sheet);
        EXPECT_FALSE(material.double_sided);
    }
    (void)apply(media_of(R"("Leaf": {"thin_walled": {"transmit": [0, 1, 0]}})"), scene);
    ASSERT_TRUE(scene.materials[0].sheet);
    EXPECT_EQ(scene.materials[0].sheet->transmit, (formats::Rgb{0, 1, 0}));
    EXPECT_EQ(scene.materials[0].base_color, (formats::Rgb{1, 1, 1}));
    EXPECT_TRUE(scene.materials[0].double_sided);
}

// glTF's default is a metal, which would have no diffuse light for the sheet to share out.
TEST(ApplyMedia, AThinWalledEntryIsNoMetalAndAnOpaqueOneIsAgain) {
    Scene scene = scene_of({"Paper"});
    scene.materials[0].gloss.metallic = 1;
    (void)apply(media_of(R"("Paper": {"thin_walled": {"transmit": [1, 1, 1]}})"), scene);
    EXPECT_EQ(scene.materials[0].gloss.metallic, 0);
    (void)apply(media_of(R"("Paper": {"thin_walled": {"reflect": [1, 1, 1]}})"), scene);
    EXPECT_EQ(scene.materials[0].gloss.metallic, 0);
    (void)apply(media_of(R"("Paper": {"opaque": true})"), scene);
    EXPECT_EQ(scene.materials[0].gloss.metallic, 1);
}

TEST(ApplyMedia, BaseColourIsThatOfTheEntryThenWhiteInAMediumThenTheFactor) {
    Scene scene = scene_of({"A", "B", "C"});
    for (formats::Material& material : scene.materials) {
        material.base_color = {0.1f, 0.2f, 0.3f};
    }
    (void)apply(media_of(R"("A": {"preset": "cream", "base_color": [1, 1, 0]},
                                  "B": {"preset": "cream"}, "C": {"opaque": true})"),
                scene);
    EXPECT_EQ(scene.materials[0].base_color, (Rgb{1, 1, 0}));
    EXPECT_EQ(scene.materials[1].base_color, (Rgb{1, 1, 1}));
    EXPECT_EQ(scene.materials[2].base_color, (Rgb{0.1f, 0.2f, 0.3f}));
}

TEST(ApplyMedia, NameThatNoMaterialHasIsAWarningThatListsTheScenes) {
    Scene scene = scene_of({"Body"});
    const auto warnings =
        apply(media_of(R"("Bodi": {"preset": "marble"}, "*": {"preset": "cream"})"), scene);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].severity, formats::Diagnostic::Severity::warning);
    EXPECT_EQ(warnings[0].where, "materials > Bodi");
    EXPECT_THAT(warnings[0].remedy, HasSubstr("'Body'"));
}

TEST(ApplyMedia, ManyNamesThatNoMaterialHasAreOneWarningWithTheirNumber) {
    Scene scene = scene_of({"Body"});
    formats::MediaFile media;
    media.materials.resize(100001);
    media.materials[0].name = "Body";
    for (std::size_t i = 1; i < media.materials.size(); ++i) {
        media.materials[i].name = "M" + std::to_string(i);
    }
    const auto warnings = apply(media, scene);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_EQ(warnings[0].where, "materials");
    EXPECT_THAT(warnings[0].fault, HasSubstr("100000 names: 'M1', 'M2'"));
    EXPECT_LT(warnings[0].fault.size(), 200u);
}

TEST(ApplyMedia, FilesJoinTheInputsAndTheHash) {
    const auto marble = media_of(R"("*": {"preset": "marble"})");
    const auto cream = media_of(R"("*": {"preset": "cream"})");
    Scene a = scene_of({"Body"}), b = a, c = a;
    const std::string before = a.sha256;
    (void)apply(marble, a);
    (void)apply(cream, b);
    (void)apply(marble, c);
    EXPECT_THAT(a.inputs, ElementsAre("scene.glb", marble.inputs.at(0)));
    EXPECT_EQ(a.sha256.size(), 64u);
    EXPECT_NE(a.sha256, before);
    EXPECT_NE(a.sha256, b.sha256);
    EXPECT_EQ(a.sha256, c.sha256);
}

TEST(ApplyMedia, AlbedoIsOneImageForAllMaterialsOfItsEntryAndReplacesTheirs) {
    Scene scene = scene_of({"A", "B", "C"});
    scene.images.push_back({1, 1, {9, 9, 9, 255}});
    scene.materials[0].base_color_image = scene.materials[2].base_color_image = 0;
    formats::MediaFile media = media_of(R"("*": {"preset": "cream"}, "C": {"opaque": true})");
    for (formats::MaterialMedium& entry : media.materials) {
        if (entry.name == "*") {
            entry.albedo = formats::Image8{1, 1, {1, 2, 3, 255}};
        }
    }
    (void)apply(media, scene);
    ASSERT_EQ(scene.images.size(), 2u);
    EXPECT_EQ(scene.images[1].rgba[1], 2);
    EXPECT_EQ(scene.materials[0].base_color_image, 1u);
    EXPECT_EQ(scene.materials[1].base_color_image, 1u);
    EXPECT_EQ(scene.materials[2].base_color_image, 0u);
}

TEST(ApplyMedia, AlbedoOnAPrimitiveWithoutTextureCoordinatesIsAnError) {
    Scene scene = scene_of({"Body"});
    scene.primitives.resize(1);
    scene.primitives[0].name = "node 'Swan'";
    scene.primitives[0].index = {0, 1, 2};
    formats::MediaFile media = media_of(R"("Body": {"preset": "cream"})");
    media.materials.at(0).albedo = formats::Image8{1, 1, {1, 2, 3, 255}};
    const auto refused = apply_media(media, scene);
    ASSERT_FALSE(refused.has_value());
    const formats::Diagnostic& fault = refused.error().diagnostics.at(0);
    EXPECT_EQ(fault.where, "materials > Body > albedo_texture");
    EXPECT_THAT(fault.fault, ::testing::AllOf(HasSubstr("node 'Swan'"), HasSubstr("TEXCOORD_0")));
    EXPECT_FALSE(scene.materials[0].medium.has_value());

    scene.primitives[0].texcoord.resize(3);
    EXPECT_TRUE(apply_media(media, scene).has_value());
}

TEST(ApplyMedia, ImagesOfAVaryingMediumAreThereOnceAndOfNoFile) {
    Scene scene = scene_of({"A", "B"});
    scene.primitives.resize(1);
    scene.primitives[0].index = {0, 1, 2};
    scene.materials[0].wrap_v = formats::TextureWrap::mirror;
    formats::MediaFile media = media_of(R"("*": {"preset": "cream", "marble": {"inside": true}})");
    formats::MaterialMedium& entry = media.materials.at(0);
    entry.scatter = formats::Image8{1, 1, {1, 2, 3, 255}};
    entry.density = formats::Image8{1, 1, {9, 9, 9, 255}};
    const auto refused = apply_media(media, scene);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().diagnostics.at(0).where, "materials > * > scatter_texture");

    scene.primitives[0].texcoord.resize(3);
    (void)apply(media, scene);
    EXPECT_TRUE(scene.images.empty());
    ASSERT_EQ(scene.inner_images.size(), 2u);
    for (const formats::Material& material : scene.materials) {
        EXPECT_EQ(material.base_color_image, formats::kNone);
        EXPECT_FALSE(material.marble);
        ASSERT_TRUE(material.medium && material.medium->variation);
        const formats::Variation& variation = *material.medium->variation;
        EXPECT_TRUE(variation.marble);
        EXPECT_EQ(scene.inner_images.at(variation.color.image).rgba[1], 2);
        EXPECT_EQ(scene.inner_images.at(variation.density.image).rgba[1], 9);
        EXPECT_EQ(variation.strength.image, formats::kNone);
        EXPECT_EQ(variation.color.wrap_v, material.wrap_v);
    }
}

}  // namespace
}  // namespace opaline::tests
