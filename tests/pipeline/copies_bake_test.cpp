// Copies that share rows show what the same meshes with rows of their own show.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/effects/interreflection/interreflection.h"
#include "bake/scene/copies.h"
#include "tests/formats/opal/opal_bytes.h"
#include "tests/support/bake.h"

namespace opaline::bake {
namespace {

// Dented balls far apart, each above a floor of its own that reflects light to it; one is larger,
// and no copy.
formats::Scene make_far_balls() {
    formats::Scene scene = tests::make_dented_ball();
    for (std::size_t i = 1; i < 4; ++i) {
        const glm::vec3 offset{200 * static_cast<float>(i), 0, 0};
        scene.primitives.emplace_back().copy = {0, offset};
        scene.primitives.emplace_back().copy = {1, offset};
    }
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        scene.primitives[p].node = p / 2;
    }
    scene.primitives.push_back(tests::make_sphere(3, 2, {100, 0, 60}));
    return scene;
}

formats::Scene expanded(formats::Scene scene) {
    expand_copies(find_copied_meshes(scene), scene);
    return scene;
}

TEST(CopiesBake, AFileOfCopiesShowsWhatTheirMeshesShow) {
    BakeOptions options;
    options.threads = 2;
    options.refine.mode = RefineChoice::Mode::off;
    options.set(kBounceRays, 144);
    const formats::Scene scene = make_far_balls(), whole = expanded(scene);
    const BakeResult shared = tests::bake_scene(scene, options),
                     apart = tests::bake_scene(whole, options);
    EXPECT_LT(2 * shared.asset.transport.view().rows(), apart.asset.transport.view().rows());
    const tests::StoredAsset stored(shared.asset), other(apart.asset);
    ASSERT_EQ(stored.view().receivers(), other.view().receivers());
    for (const char* light : {"white", "studio"}) {
        const auto a = tests::relight(stored.view(), light),
                   b = tests::relight(other.view(), light);
        double error = 0, sum = 0;
        for (std::size_t v = 0; v < a.size(); ++v) {
            EXPECT_NEAR(stored.view().position[v].x, other.view().position[v].x, 1e-4f);
            error += std::pow(static_cast<double>(a[v].g - b[v].g), 2);
            sum += std::pow(static_cast<double>(b[v].g), 2);
        }
        EXPECT_LT(std::sqrt(error / sum), 0.03) << light << ": noise of bounces, and coefficients";
    }
    EXPECT_NEAR(shared.error.rms_relative, apart.error.rms_relative, 0.02);
}

// With a black box around the first copy, which then has the rows of one under the open sky.
formats::Scene with_dark_copy(formats::Scene scene) {
    formats::Primitive box = tests::make_cube(2, true);
    for (glm::vec3& at : box.position) {
        at = 6.0f * at + scene.primitives[2].copy.offset;
    }
    box.material = 1;
    scene.materials.push_back({.name = "Black", .base_color = {0, 0, 0}, .double_sided = true});
    scene.primitives.push_back(box);
    return scene;
}

TEST(CopiesBake, TheStatedErrorLooksAtCopies) {
    BakeOptions options;
    options.threads = 2;
    options.refine.mode = RefineChoice::Mode::off;
    const formats::Scene scene = make_far_balls();
    const double before = tests::bake_scene(scene, options).error.rms_relative;
    EXPECT_GT(tests::bake_scene(with_dark_copy(scene), options).error.rms_relative, before + 0.2);
}

TEST(CopiesBake, TheModelCheckLooksAtCopies) {
    BakeOptions options;
    options.threads = 2;
    options.refine.mode = RefineChoice::Mode::off;
    options.check_model = true;
    const formats::Scene scene = make_far_balls();
    const BakeResult open = tests::bake_scene(scene, options),
                     dark = tests::bake_scene(with_dark_copy(scene), options);
    ASSERT_TRUE(open.model_error && dark.model_error);
    EXPECT_LT(open.model_error->rms_relative, 0.12);
    EXPECT_GT(dark.model_error->rms_relative, open.model_error->rms_relative + 0.2);
}

}  // namespace
}  // namespace opaline::bake
