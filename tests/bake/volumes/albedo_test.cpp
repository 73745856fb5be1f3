// Volumes whose albedo varies from place to place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/effects/volumes/node_albedo.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "formats/media/split_absorption.h"
#include "runtime/volumes/volume_march.h"
#include "tests/bake/volumes/volume_support.h"

namespace opaline::bake {
namespace {

constexpr glm::vec3 kRed(0.9f, 0.6f, 0.3f);

// From one albedo to the other within a quarter of a metre.
formats::Volume varied_blob(float g, glm::vec3 below, glm::vec3 above) {
    formats::Volume blob = tests::make_volume(tests::make_blob(0.5, 0.125), 3, 0, g);
    tests::vary_albedo(blob, [&](glm::dvec3 p) {
        return glm::mix(below, above, static_cast<float>(std::clamp(0.5 + 4 * p.y, 0.0, 1.0)));
    });
    return blob;
}

runtime::MarchResult march_white(const formats::Volumes& volumes, float off, float glow = 1) {
    const runtime::LightVector white = runtime::project_cubemap(
        std::vector<formats::Rgb>(formats::cubemap_texels(8), {1, 1, 1}), 8);
    const std::vector<formats::Rgb> colors{{glow, glow, glow}};
    const runtime::VolumeLight lit =
        runtime::relight_volumes(volumes.view(), white, {.emitters = {colors}});
    return runtime::march_volumes(runtime::light_volumes(volumes.view(), lit),
                                  {{-4, off, 0.1f}, {1, 0, 0}});
}

TEST(VariedAlbedo, TheSameAtAllVoxelsItIsTheNumber) {
    constexpr float kForward = 0.85f;
    formats::Volume plain = tests::make_volume(tests::make_blob(0.5, 0.125), 3, 0, kForward);
    plain.albedo = {kRed.x, kRed.y, kRed.z};
    const formats::Volumes number =
        tests::bake_volumes_of(tests::scene_of(plain), tests::small_knobs(Quality::preview, 4));
    const formats::Volumes grid =
        tests::bake_volumes_of(tests::scene_of(varied_blob(kForward, kRed, kRed)),
                               tests::small_knobs(Quality::preview, 4));
    for (const float off : {0.0f, 0.4f, -0.8f}) {
        const runtime::MarchResult a = march_white(number, off), b = march_white(grid, off);
        EXPECT_NEAR(a.transmittance.r, b.transmittance.r, 1e-4f);
        EXPECT_NEAR(a.radiance.r, b.radiance.r, 5e-3f * a.radiance.r);
        EXPECT_NEAR(a.radiance.b, b.radiance.b, 5e-3f * a.radiance.b);
    }
}

// The largest error of one ray, and that of their mean.
struct Unseen {
    double worst = 0, mean = 0;
};

Unseen look_at_equilibrium(formats::Volume blob, bool is_split) {
    tests::make_it_glow(blob, glm::vec3(1));
    formats::Scene scene = tests::scene_of(blob);
    if (is_split) {
        scene.volumes.push_back(*formats::split_absorption(scene.volumes[0]));
    }
    const formats::Volumes volumes =
        tests::bake_volumes_of(scene, tests::small_knobs(Quality::preview, 4));
    Unseen unseen;
    for (int i = -8; i <= 8; ++i) {
        const runtime::MarchResult seen = march_white(volumes, 0.1f * static_cast<float>(i));
        const double error = static_cast<double>(seen.radiance.g + seen.transmittance.g) - 1;
        unseen.worst = std::max(unseen.worst, std::abs(error));
        unseen.mean += error / 17;
    }
    const auto dark = [&](float off) { return march_white(volumes, off, 0).radiance.g; };
    EXPECT_LT(dark(0.3f), 0.4f * dark(-0.3f)) << "without its light it is not in equilibrium";
    return unseen;
}

TEST(VariedAlbedo, SplitIntoWhatScattersAndWhatAbsorbsItCannotBeSeenInEquilibrium) {
    for (const float g : {0.0f, 0.85f}) {
        const Unseen unseen =
            look_at_equilibrium(varied_blob(g, glm::vec3(0.9f), glm::vec3(0.1f)), true);
        EXPECT_LT(unseen.worst, 0.06) << "g " << g;
        EXPECT_NEAR(unseen.mean, 0, 0.03) << "g " << g;
    }
}

TEST(VariedAlbedo, KnownAtNodesAloneItCannotBeSeenInEquilibriumButWhereItChanges) {
    const Unseen unseen =
        look_at_equilibrium(varied_blob(0.85f, glm::vec3(0.9f), glm::vec3(0.1f)), false);
    EXPECT_LT(unseen.worst, 0.35);
    EXPECT_GT(unseen.worst, 0.1) << "else it needs no splitting";
    EXPECT_NEAR(unseen.mean, 0, 0.03);
}

TEST(VariedAlbedo, AForwardPeakTakesNothingFromWhatIsAbsorbed) {
    const formats::Volume blob = varied_blob(0.85f, kRed, glm::vec3(0.5f, 0.7f, 0.4f));
    const auto f = scale_phase(blob.phase).peak;
    ASSERT_GT(f, 0.3);
    const ScaledMedium scaled = scale_medium(blob, f);
    ASSERT_NE(scaled.grids, nullptr);
    for (std::size_t i = 0; i < blob.density.value.size(); ++i) {
        const glm::vec3 absorbed = 3.0f * (blob.density.value[i] - blob.scattering.value[i]);
        const glm::vec3 left = scaled.grids->density.value[i] - scaled.grids->scattering.value[i];
        for (int band = 0; band < 3; ++band) {
            EXPECT_NEAR(scaled.sigma_t[static_cast<std::size_t>(band)] * left[band], absorbed[band],
                        1e-5f);
        }
    }
}

TEST(VariedAlbedo, NodesHaveTheAlbedoThatIsAroundThem) {
    formats::Volume box = tests::make_volume(
        tests::sample_grid(glm::dvec3(16), 1, [](glm::dvec3) { return 1.0; }), 1, 0, 0);
    tests::vary_albedo(box, [](glm::dvec3 p) { return glm::vec3(0.5f + 0.02f * float(p.x)); });
    const formats::Scene scene = tests::scene_of(box);
    const DensitySpace space = make_density_space(scene);
    const NodeLattice lattice = make_node_lattice(box.density, 4);
    const std::vector<glm::vec3> shares = node_albedo_shares(space.volumes[0], lattice);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        if (std::abs(lattice.node[i].x) > 12) continue;
        EXPECT_NEAR(shares[i].x * space.volumes[0].albedo[0],
                    0.5f + 0.02f * static_cast<float>(lattice.node[i].x), 1e-4f);
    }
    EXPECT_LT(lost_albedo_detail(space.volumes[0], 4), 0.02) << "a ramp is linear";
}

TEST(VariedAlbedo, NodesStandAsCloseAsAlbedosDiffer) {
    Knobs knobs = tests::knobs_for(Quality::preview);
    const auto spacing_of = [&](float other) {
        formats::Volume ball = tests::make_volume(tests::make_ball_grid(1, 1.0 / 16), 0.5f, 0, 0);
        tests::vary_albedo(
            ball, [&](glm::dvec3 p) { return glm::vec3(std::sin(9 * p.x) > 0 ? 1.0f : other); });
        return plan_volumes(tests::scene_of(ball), knobs).layouts.at(0).spacing;
    };
    EXPECT_EQ(spacing_of(0.95f), 8u);
    EXPECT_LT(spacing_of(0), 8u);
    knobs.quality = Quality::production;
    EXPECT_EQ(spacing_of(0), 1u);
}

}  // namespace
}  // namespace opaline::bake
