#include "bake/scene/coverage.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opaline::bake {
namespace {

using formats::Material;

/// A triangle with coordinates (0, 1/2), (1, 1/2), (0, 1/2) over an image that is opaque left of
/// the middle and clear right of it.
formats::Scene leaf(Material::AlphaMode mode, bool textured) {
    formats::Scene scene;
    scene.materials.resize(1);
    scene.materials[0].alpha_mode = mode;
    formats::Primitive& p = scene.primitives.emplace_back();
    p.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.texcoord = {{0, 0.5f}, {1, 0.5f}, {0, 0.5f}};
    p.index = {0, 1, 2};
    if (textured) {
        scene.materials[0].base_color_image = 0;
        scene.materials[0].wrap_u = formats::TextureWrap::clamp;
        scene.images.push_back({2, 1, {0, 0, 0, 255, 0, 0, 0, 0}});
    }
    return scene;
}

Coverage coverage_of(const formats::Scene& scene) {
    CoverageImages images;
    auto coverage = make_coverage(scene, 0, images);
    EXPECT_TRUE(coverage.has_value());
    return std::move(coverage).value_or(Coverage{});
}

TEST(Coverage, OpaqueMaterialsAndMediaHaveNoHoles) {
    CoverageImages images;
    formats::Scene scene = leaf(Material::AlphaMode::opaque, true);
    EXPECT_FALSE(make_coverage(scene, 0, images).has_value());
    scene = leaf(Material::AlphaMode::mask, true);
    scene.materials[0].medium.emplace();
    EXPECT_FALSE(make_coverage(scene, 0, images).has_value());
    EXPECT_TRUE(images.empty());
}

TEST(Coverage, AMaskIsThereWhereAlphaReachesItsCutoff) {
    formats::Scene scene = leaf(Material::AlphaMode::mask, true);
    for (const float cutoff : {0.25f, 0.5f, 0.75f}) {
        scene.materials[0].alpha_cutoff = cutoff;
        const Coverage coverage = coverage_of(scene);
        // Alpha falls from 1 at u = 1/4 to 0 at u = 3/4.
        const float edge = 0.25f + 0.5f * (1 - cutoff);
        EXPECT_EQ(coverage_at(coverage, 0, edge - 0.01f, 0), 1.0f);
        EXPECT_EQ(coverage_at(coverage, 0, edge + 0.01f, 0), 0.0f);
    }
    // At the cutoff it is there; above 1 nothing is.
    scene = leaf(Material::AlphaMode::mask, false);
    scene.materials[0].alpha = scene.materials[0].alpha_cutoff = 0.5f;
    EXPECT_EQ(coverage_at(coverage_of(scene), 0, 0.3f, 0.3f), 1.0f);
    scene.materials[0].alpha_cutoff = 1.5f;
    EXPECT_EQ(coverage_at(coverage_of(scene), 0, 0.3f, 0.3f), 0.0f);
}

TEST(Coverage, IsTheProductOfFactorVerticesAndTexture) {
    formats::Scene scene = leaf(Material::AlphaMode::blend, true);
    scene.materials[0].alpha = 0.5f;
    scene.primitives[0].alpha = {1, 0, 1};
    EXPECT_NEAR(coverage_at(coverage_of(scene), 0, 0.5f, 0), 0.5f * 0.5f * 0.5f, 1e-6f);
    scene.primitives[0].texcoord.clear();
    EXPECT_NEAR(coverage_at(coverage_of(scene), 0, 0.5f, 0), 0.5f * 0.5f, 1e-6f);
}

TEST(Coverage, RaysMeetAShareByItsProbabilityAndLayersIndependently) {
    formats::Scene scene = leaf(Material::AlphaMode::blend, false);
    scene.materials[0].alpha = 0.3f;
    const Coverage coverage = coverage_of(scene);
    constexpr int kRays = 100000;
    // By the direction alone, by the origin alone, and by the key alone.
    for (int by = 0; by < 3; ++by) {
        double first = 0, both = 0, neighbours = 0;
        bool before = false;
        for (int i = 0; i < kRays; ++i) {
            const float x = static_cast<float>(i) / kRays;
            Passage passage{{by == 1 ? x : 0.5f, 0, 1},
                            {by == 0 ? x : 0.5f, 0.1f, -1},
                            by == 2 ? static_cast<std::uint32_t>(i) : 0,
                            0,
                            0};
            const bool meets = meets_surface(coverage, passage, 0.2f, 0.2f);
            EXPECT_EQ(meets, meets_surface(coverage, passage, 0.2f, 0.2f));
            passage.primitive = 1;
            const bool other = meets_surface(coverage, passage, 0.2f, 0.2f);
            first += meets ? 1 : 0;
            both += meets && other ? 1 : 0;
            neighbours += meets && before ? 1 : 0;
            before = meets;
        }
        const auto within = [&](double count, double p) {
            EXPECT_NEAR(count / kRays, p, 4 * std::sqrt(p * (1 - p) / kRays)) << by;
        };
        within(first, 0.3);
        within(both, 0.09);
        within(neighbours, 0.09);
    }
}

// Of index 1.5 a face reflects R = 0.04 along the normal: two of them let (1 - R) / (1 + R) pass.
TEST(Coverage, GlassLetsPassWhatTwoFacesDoNotReflect) {
    formats::Scene scene = leaf(Material::AlphaMode::opaque, false);
    scene.materials[0].sheet = formats::Sheet{.clear = 1};
    const Coverage glass = coverage_of(scene);
    const auto met = [&](float cosine) {
        constexpr int kRays = 40000;
        int sum = 0;
        for (int i = 0; i < kRays; ++i) {
            sum += meets_surface(glass, {{static_cast<float>(i), 0, 0}, {0, 0, 1}, 0, 0, 0, cosine},
                                 0.3f, 0.3f);
        }
        return static_cast<double>(sum) / kRays;
    };
    EXPECT_NEAR(met(1), 2 * 0.04 / 1.04, 0.004);
    EXPECT_NEAR(met(0.01f), 1, 0.08) << "grazing";
    scene.materials[0].alpha_mode = Material::AlphaMode::mask;
    scene.materials[0].alpha_cutoff = 2;
    EXPECT_FALSE(meets_surface(coverage_of(scene), {}, 0.3f, 0.3f)) << "there is no glass";
}

}  // namespace
}  // namespace opaline::bake
