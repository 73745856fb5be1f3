// Light that volumes scatter to surfaces, at points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <span>

#include "bake/base/frame.h"
#include "bake/effects/volumes/complete_rows.h"
#include "bake/effects/volumes/largest_light.h"
#include "bake/effects/volumes/sent_light.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/trace/density/attenuation.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/bake/volumes/volume_support.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr double kPi = std::numbers::pi;

// A scene's volumes, baked, among surfaces that its primitives are.
struct SentScene {
    formats::Scene scene;
    Knobs knobs;
    RayScene surfaces;
    std::vector<VolumeLayout> layouts;
    formats::Volumes volumes;

    SentScene(formats::Scene given, const Knobs& wanted)
        : scene(std::move(given)),
          knobs(wanted),
          surfaces(std::move(*RayScene::build(scene, 1))),
          layouts(plan_volumes(scene, knobs).layouts),
          volumes(tests::bake_volumes_of(scene, surfaces, knobs)) {
        for (VolumeLayout& layout : layouts) {
            layout.lights_surfaces = true;
        }
    }
    SentIrradiance at(const Receiver& receiver) const {
        Knobs many = knobs;
        many.quality = Quality::reference;  // of its rays alone: their noise is no matter here
        return gather_sent_light(make_sent_light(scene, surfaces, layouts, volumes.view(), many),
                                 receiver);
    }
};

SentScene ball_of_smoke(float sigma_t, float albedo, float g, double spacing = 4) {
    return {
        tests::scene_of(tests::make_volume(tests::make_ball_grid(1, 0.125), sigma_t, albedo, g)),
        tests::small_knobs(Quality::preview, spacing)};
}

// Of even light of radiance 1, in one band.
double under_even_light(const SentIrradiance& sent, std::size_t band = 0) {
    const std::vector<double> face = formats::texel_solid_angles(8);
    double sum = 0;
    for (std::size_t i = 0; i < 6 * face.size(); ++i) {
        sum += static_cast<double>(sent.rows[band * 6 * face.size() + i]) * face[i % face.size()];
    }
    return sum;
}

// int cos (1 - e^-tau) dw over the hemisphere of a receiver, by 128 x 128 directions.
double hidden_share(const DensitySpace& space, const Receiver& at) {
    const Frame frame = make_frame(at.normal);
    constexpr int kSide = 128;
    double sum = 0;
    for (int i = 0; i < kSide; ++i) {
        const double q = (i + 0.5) / kSide;
        for (int j = 0; j < kSide; ++j) {
            const double angle = 2 * kPi * (j + 0.5) / kSide;
            const glm::vec3 direction = frame.to_world(glm::vec3(
                std::sqrt(q) * std::cos(angle), std::sqrt(q) * std::sin(angle), std::sqrt(1 - q)));
            sum += -std::expm1(-static_cast<double>(optical_depth(space, at.origin, direction)[0]));
        }
    }
    return kPi * sum / (kSide * kSide);
}

// Smoke that absorbs nothing cannot be seen in even light: what it hides of the sky it sends.
TEST(SentLight, SmokeThatAbsorbsNothingSendsAsMuchOfAnEvenSkyAsItHides) {
    for (const float g : {0.0f, 0.5f}) {
        const SentScene smoke = ball_of_smoke(2, 1, g, 2);
        const DensitySpace space = make_density_space(smoke.scene);
        for (const Receiver& at : {Receiver{{0, -1.5f, 0}, {0, 1, 0}},
                                   Receiver{{1.2f, -1, 0.3f}, glm::normalize(glm::vec3(-1, 1, 1))},
                                   Receiver{{0.2f, 0.1f, 0}, {0, 1, 0}}}) {
            const double hidden = hidden_share(space, at);
            EXPECT_GT(hidden, 0.3);
            EXPECT_NEAR(under_even_light(smoke.at(at)), hidden, 0.05 * hidden)
                << "g " << g << ", from " << at.origin.x;
        }
    }
}

// From far away a thin ball is a point of scattering cross section alpha c' times its volume:
//     E(l) = cos / D^2 alpha c' int dV p'(-l . w_o).
TEST(SentLight, ThinBallFarAwayScattersByItsPhaseFunction) {
    const float distance = 4;
    const SentScene smoke = ball_of_smoke(0.03f, 0.5f, 0.4f);
    const DensityVolume volume = make_density_space(smoke.scene).volumes.at(0);
    const auto& density = smoke.scene.volumes[0].density.value;
    const double voxels = std::accumulate(density.begin(), density.end(), 0.0);
    const glm::vec3 toward = glm::normalize(glm::vec3(0.5f, 1, 0.2f));
    const SentIrradiance sent = smoke.at({-distance * toward, {0, 1, 0}});
    const double scale = static_cast<double>(volume.albedo[0] * volume.sigma_t[0] * toward.y) *
                         voxels / 512 / static_cast<double>(distance * distance);
    const LightCells cells = make_light_cells(8);
    double product = 0, sent_square = 0, true_square = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        // Light that comes from the cell goes on to the receiver, along -toward.
        const double cosine = static_cast<double>(glm::dot(cells.direction(i), toward));
        const double truth =
            scale * static_cast<double>(eval_scaled(volume.phase, static_cast<float>(cosine)));
        const auto found = static_cast<double>(sent.rows[i]);
        product += truth * found;
        sent_square += found * found;
        true_square += truth * truth;
    }
    EXPECT_NEAR(product / true_square, 1, 0.1) << "energy, with the noise of some fifty rays";
    EXPECT_GT(product / std::sqrt(sent_square * true_square), 0.998) << "its directions";
}

TEST(SentLight, SmokeBehindAWallOrBelowTheHorizonSendsNothing) {
    formats::Scene scene =
        tests::make_scene({tests::make_quad({-20, -1.2f, -20}, {0, 0, 40}, {40, 0, 0})});
    scene.volumes.push_back(tests::make_volume(tests::make_ball_grid(1, 0.125), 2, 1, 0));
    const SentScene smoke(std::move(scene), tests::small_knobs(Quality::preview, 4));
    const auto brightest = [&](const Receiver& at) {
        const std::vector<float> rows = smoke.at(at).rows;
        return *std::ranges::max_element(rows);
    };
    EXPECT_EQ(brightest({{0, -1.3f, 0}, {0, 1, 0}}), 0) << "under the floor";
    EXPECT_EQ(brightest({{0, 1.3f, 0}, {0, 1, 0}}), 0) << "above, facing away";
    EXPECT_EQ(brightest({{0, -1.1f, 0}, {0, 0, 0}}), 0) << "without a normal";
    EXPECT_GT(brightest({{0, -1.1f, 0}, {0, 1, 0}}), 0.01f);
}

TEST(SentLight, SmokeThatAbsorbsByColourSendsColours) {
    formats::Volume volume = tests::make_volume(tests::make_ball_grid(1, 0.125), 2, 1, 0);
    volume.albedo = {1, 0.5f, 0};
    const SentScene smoke(tests::scene_of(std::move(volume)),
                          tests::small_knobs(Quality::preview, 4));
    const SentIrradiance sent = smoke.at({{0, -1.5f, 0}, {0, 1, 0}});
    ASSERT_EQ(sent.rows.size(), 3u * 384u);
    EXPECT_GT(under_even_light(sent, 0), 3 * under_even_light(sent, 1));
    EXPECT_GT(under_even_light(sent, 1), 0);
    EXPECT_EQ(under_even_light(sent, 2), 0);
}

// The wall of a hollow of white glass shows an even sky of which it sees a tenth: all but that
// tenth came by other walls. Smoke in the hollow lit it as if ten times as bright.
TEST(SentLight, BodiesShowNoMoreOfItThanArrives) {
    EXPECT_NEAR(kPi * double{answer_of_medium(0.96, 0.1f, 0.96).front}, 1, 1e-6);
    EXPECT_NEAR(kPi * double{answer_of_medium(0.4, 0.5f, 0.4).front}, 0.8, 1e-6)
        << "half of the sky, of which .2 is absorbed";
    EXPECT_NEAR(kPi * double{answer_of_medium(-0.2, 1, 0.9).front}, -0.2, 1e-6)
        << "in the open, a row of views";
}

TEST(PlanSentLight, NoSurfaceReceivesMoreThanTheBoundAndTheNearestOneAGoodPartOfIt) {
    const float distance = 2.5f;
    formats::Scene scene = tests::make_scene(
        {tests::make_quad({-0.01f, -distance, -0.01f}, {0, 0, 0.02f}, {0.02f, 0, 0})});
    // A box around a ball is longer and wider than the ball.
    for (const auto& [sigma_t, share] : {std::pair(0.05f, 0.07), std::pair(8.0f, 0.2)}) {
        scene.volumes = {tests::make_volume(tests::make_ball_grid(1, 0.125), sigma_t, 1, 0)};
        const double bound = largest_sent_light(scene, scene.volumes[0]);
        const SentScene smoke(scene, tests::small_knobs(Quality::preview, 4));
        const double sent =
            under_even_light(smoke.at({{0, -distance + 1e-4f, 0}, {0, 1, 0}})) / kPi;
        EXPECT_LE(sent, bound);
        EXPECT_GT(sent, share * bound);
    }
}

TEST(PlanSentLight, ItIsLeftOutWhereItIsDarkOrFarAwayOrNothingReceivesIt) {
    const auto decide = [](float sigma_t, float distance) {
        formats::Scene scene =
            tests::make_scene({tests::make_quad({-1, -distance, -1}, {0, 0, 2}, {2, 0, 0})});
        scene.volumes = {tests::make_volume(tests::make_ball_grid(1, 0.125), sigma_t, 0.9f, 0)};
        return plan_volumes(scene, tests::small_knobs(Quality::preview, 4));
    };
    const VolumePlan near = decide(2, 1.5f);
    ASSERT_EQ(near.entries.size(), 4u);
    EXPECT_EQ(near.entries[2].name, "volume-surface");
    EXPECT_TRUE(near.entries[2].on);
    EXPECT_TRUE(near.layouts.at(0).lights_surfaces);
    EXPECT_TRUE(lights_surfaces(near.entries));
    EXPECT_FALSE(lights_surfaces(decide(2, 100).entries));
    EXPECT_FALSE(decide(2, 100).layouts.at(0).lights_surfaces);
    EXPECT_FALSE(lights_surfaces(decide(2e-4f, 1.5f).entries));
    const formats::Scene alone =
        tests::scene_of(tests::make_volume(tests::make_ball_grid(1, 0.125), 2, 0.9f, 0));
    EXPECT_EQ(plan_volumes(alone, tests::small_knobs(Quality::preview, 4)).entries.size(), 2u);
}

std::vector<float> random_cells(std::uint32_t n) {
    std::mt19937 engine(n);
    std::uniform_real_distribution<float> uniform(0, 1);
    std::vector<float> values(formats::cubemap_texels(n));
    for (float& value : values) {
        value = uniform(engine);
    }
    return values;
}

TEST(LightCells, CoarseCellsTransformLikeTheFineOnesTheyStandFor) {
    const std::vector<float> coarse = random_cells(8);
    std::vector<float> fine(formats::cubemap_texels(32));
    for (std::size_t i = 0; i < fine.size(); ++i) {
        const std::size_t column = i % 32, row = i / 32 % 32, face = i / 1024;
        fine[i] = coarse[(face * 8 + row / 4) * 8 + column / 4];
    }
    formats::haar_forward_cube(std::span<float>(fine), 32);
    const std::vector<float> transformed = transform_cells(coarse, 8, 32);
    ASSERT_EQ(transformed.size(), fine.size());
    for (std::size_t i = 0; i < fine.size(); ++i) {
        EXPECT_NEAR(transformed[i], fine[i], 2e-5);
    }
}

TEST(LightCells, ReducingKeepsTheMeanOfEachBlock) {
    const std::vector<float> fine = random_cells(16), coarse = reduce_cells(fine, 16, 8);
    EXPECT_NEAR(coarse[9], (fine[34] + fine[35] + fine[50] + fine[51]) / 4, 1e-6);
    EXPECT_EQ(reduce_cells(fine, 16, 16), fine);
}

TEST(LightCells, DirectionsAreThoseOfTheFile) {
    const LightCells cells = make_light_cells(8);
    ASSERT_EQ(cells.size(), 384u);
    for (std::size_t i = 0; i < cells.size(); i += 7) {
        const glm::vec3 d = cells.direction(i);
        EXPECT_EQ(formats::texel_index(8, {d.x, d.y, d.z}), i);
    }
}

}  // namespace

}  // namespace opaline::bake
