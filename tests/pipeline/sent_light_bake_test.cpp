// Light that volumes scatter to surfaces, in files.
#include <gtest/gtest.h>

#include <cmath>

#include "bake/accuracy/check_model.h"
#include "formats/opal/cubemap.h"
#include "tests/support/media_bake.h"
#include "tests/support/sheets.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

// An opaque patch, a leaf and a body beside a place for smoke, small against it.
Scene make_small_things() {
    Primitive leaf = make_quad({1.6f, 0.2f, -0.05f}, {0, 0.1f, 0}, {0, 0, 0.1f});
    leaf.material = 1;
    Primitive body = make_sphere(1, 0.08f, {-1.7f, 0, 0});
    body.material = 2;
    Scene scene =
        make_scene({make_quad({-0.05f, -1.6f, -0.05f}, {0, 0, 0.1f}, {0.1f, 0, 0}), leaf, body});
    scene.materials.resize(3);
    scene.materials[1] = {.name = "Leaf"};
    scene.materials[1].sheet = formats::Sheet{{0.5f, 0.3f, 0.2f}, {0.2f, 0.4f, 0.1f}};
    scene.materials[2] = {.name = "Wax"};
    formats::Medium& wax = scene.materials[2].medium.emplace();
    wax.sigma_s = {200, 200, 200};
    wax.sigma_a = {2, 2, 2};
    return scene;
}

formats::Volume make_smoke(float albedo) {
    return make_volume(make_ball_grid(1, 0.25), 2, albedo, 0);
}

bake::BakeOptions smoke_bake() {
    bake::BakeOptions options = small_bake();
    options.quality = bake::Quality::preview;
    return options;
}

std::vector<formats::Rgb> see_under_even_light(const Scene& scene,
                                               const bake::BakeOptions& options) {
    const bake::BakeResult result = bake_scene(scene, options);
    return relight(result.asset.view(), make_light("white", 8));
}

TEST(SentLightBake, SmokeThatAbsorbsNothingChangesNoSurfaceInEvenLight) {
    Scene scene = make_small_things();
    const auto clear = see_under_even_light(scene, smoke_bake());
    scene.volumes.push_back(make_smoke(1));
    const auto smoky = see_under_even_light(scene, smoke_bake());
    ASSERT_EQ(smoky.size(), clear.size());
    for (std::size_t i = 0; i < clear.size(); ++i) {
        EXPECT_NEAR(smoky[i].r, clear[i].r, 0.05f * clear[i].r) << i;
        EXPECT_NEAR(smoky[i].g, clear[i].g, 0.05f * clear[i].g) << i;
    }
    // It takes a tenth of the sky's light or more from what faces it.
    scene.volumes[0] = make_smoke(0);
    const auto dim = see_under_even_light(scene, smoke_bake());
    EXPECT_LT(dim[0].r, 0.9f * clear[0].r);
}

// Haar coefficients of the first primitive's rows, one after the other.
std::vector<float> decode_rows(const bake::BakeResult& result) {
    const formats::PrimitiveRecord& record = result.asset.primitives[0];
    std::vector<float> all, row(formats::cubemap_texels(result.knobs.cubemap_size));
    for (std::uint32_t v = 0; v < record.vertex_count * record.terms; ++v) {
        formats::decode_row(result.asset.transport.view(), record.rows(), v, 0, row);
        all.insert(all.end(), row.begin(), row.end());
    }
    return all;
}

double norm(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        sum += std::pow(double{a[i]} - double{b[i]}, 2);
    }
    return std::sqrt(sum);
}

// |few - all| / |all| of the same scene's rows.
double lost_share(const Scene& scene, bake::BakeOptions options, bake::BakeResult& few) {
    few = bake_scene(scene, options);
    options.coefficients = bake::kAllCoefficients;
    const std::vector<float> all = decode_rows(bake_scene(scene, options));
    return norm(decode_rows(few), all) / norm(all, std::vector<float>(all.size()));
}

// The self-check sees rows before smoke dims them, and they are truncated again after it.
TEST(SentLightBake, ErrorOfRowsThatAreTruncatedAgainInShadowsOfSmokeIsStated) {
    Scene scene = make_scene({make_quad({-1, -1.2f, -1}, {0, 0, 2}, {2, 0, 0}, 6)});
    bake::BakeOptions options = small_bake();
    options.coefficients = 12;
    bake::BakeResult clear, dim;
    const double lost_once = lost_share(scene, options, clear);
    scene.volumes.push_back(make_volume(make_ball_grid(1, 0.25), 20, 0, 0));
    const double lost = lost_share(scene, options, dim);
    ASSERT_EQ(dim.error.by_effect.back().name, "shadows of volumes");
    const double again = dim.error.by_effect.back().rms_relative;
    EXPECT_GT(again, 0.05);
    EXPECT_NEAR(std::hypot(lost_once, again), lost, 0.25 * lost);
    EXPECT_NEAR(dim.error.rms_relative, std::hypot(clear.error.rms_relative, again), 1e-9);
}

TEST(SentLightBake, LeftOutItChangesNoBitOfRows) {
    Scene scene = make_small_things();
    scene.volumes.push_back(make_smoke(1));
    bake::BakeOptions options = smoke_bake();
    options.quality = bake::Quality::draft;
    options.effects = {"direct", "sheet", "multiple", "volume-single", "volume-multiple"};
    const bake::BakeResult without = bake_scene(scene, options);
    scene.volumes[0] = make_smoke(0);
    const bake::BakeResult absorbing = bake_scene(scene, options);
    EXPECT_EQ(without.asset.transport.average_code, absorbing.asset.transport.average_code);
    EXPECT_EQ(without.asset.transport.code8, absorbing.asset.transport.code8);
    EXPECT_EQ(without.asset.transport.index16, absorbing.asset.transport.index16);
    scene.volumes[0] = make_smoke(1);
    options.effects.push_back("volume-surface");
    const bake::BakeResult with = bake_scene(scene, options);
    EXPECT_NE(without.asset.transport.code8, with.asset.transport.code8);
}

// Smoke on a floor: path tracing of the scene as it is.
TEST(SentLightBake, FileAgreesWithPathTracingAndMissesLittle) {
    Scene scene = make_scene({make_quad({-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, 8)});
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    scene.volumes.push_back(make_volume(make_ball_grid(0.9, 0.15), 3, 0.9f, 0.3f));
    const bake::BakeResult result = bake_scene(scene, smoke_bake());
    bake::ModelCheckOptions options;
    options.receivers = 48;
    options.max_events = 500000;
    const auto dimmed = bake::check_model(scene, result.asset.view(), options, {});
    options.lit_by_volumes = true;
    const auto lit = bake::check_model(scene, result.asset.view(), options, {});
    ASSERT_TRUE(dimmed && lit);
    EXPECT_GT(dimmed->missing, 0.05);
    EXPECT_LT(lit->missing, 0.25 * dimmed->missing);
    EXPECT_LT(std::abs(lit->bias), 0.03);
    EXPECT_GT(dimmed->bias, 0.05) << "the file is brighter than smoke that only dims makes it";
}

}  // namespace
}  // namespace opaline::tests
