#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "bake/effects/volumes/bake_volumes.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "formats/opal/cubemap.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"
#include "tests/bake/volumes/volume_support.h"
#include "tests/support/cut_phase.h"
#include "tests/support/volume_table.h"

namespace opaline::bake {
namespace {

using formats::Vec3;

formats::Vec3 vector_of(const tests::VolumeRow& row, const char* x, const char* y, const char* z) {
    return {static_cast<float>(row.number_or_zero(x)), static_cast<float>(row.number_or_zero(y)),
            static_cast<float>(row.number_or_zero(z))};
}

// Light of unit irradiance from the texel around a direction.
runtime::LightVector beam(Vec3 toward, std::uint32_t n) {
    std::vector<double> integral(std::size_t{3} * formats::cubemap_texels(n));
    const std::size_t texel = formats::texel_index(n, toward);
    for (std::size_t band = 0; band < 3; ++band) {
        integral[3 * texel + band] = 1;
    }
    return runtime::make_light_vector(integral, n);
}

// A volume of a row, its file and the ray of the row.
struct BakedRow {
    formats::Volumes volumes;
    runtime::MarchRay ray;
};

BakedRow bake_row(const tests::VolumeRow& row, const Knobs& knobs) {
    const double size = row.number("size");
    const bool is_ball = row.cell.at("geometry") == "sphere";
    const formats::Scene scene = tests::scene_of(tests::make_volume(
        is_ball ? tests::make_ball_grid(size, size / 8) : tests::make_blob(size, size / 4),
        static_cast<float>(row.number("sigma_t")), static_cast<float>(row.number("albedo")),
        static_cast<float>(row.number("g"))));
    BakedRow baked;
    baked.volumes = tests::bake_volumes_of(scene, knobs);
    // From well outside: an edge of a grid is a voxel wide.
    const Vec3 along = vector_of(row, "vx", "vy", "vz");
    baked.ray.direction = along;
    baked.ray.origin = vector_of(row, "px", "py", "pz") - static_cast<float>(size) * along;
    return baked;
}

Knobs fine_knobs() {
    Knobs knobs = tests::knobs_for(Quality::production);
    knobs.cubemap_size = 8;
    knobs.set(kVolumeSpacing, 2);
    knobs.set(kVolumeWalks, 128);
    knobs.set(kVolumeTerms, 25);
    return knobs;
}

double march(const BakedRow& baked, const runtime::LightVector& light) {
    const runtime::VolumeLight lit = runtime::relight_volumes(baked.volumes.view(), light);
    const runtime::LitVolumes volumes = runtime::light_volumes(baked.volumes.view(), lit);
    return static_cast<double>(runtime::march_volumes(volumes, baked.ray).radiance.g);
}

// Rows by geometry, medium and ray: the values that belong together, by quantity.
struct Group {
    tests::VolumeRow row;
    std::map<std::string, double> value;
};

std::vector<Group> groups_of(const std::string& name) {
    std::vector<Group> groups;
    for (const tests::VolumeRow& row : tests::read_volume_table()) {
        const std::string& geometry = row.cell.at("geometry");
        if (row.cell.at("group") != name || (geometry != "sphere" && geometry != "blob")) continue;
        const auto same = [&](const Group& group) {
            for (const char* column : {"geometry", "g", "albedo", "sigma_t", "size", "px", "py",
                                       "pz", "vx", "vy", "vz", "lx", "ly", "lz"}) {
                if (group.row.cell.at(column) != row.cell.at(column)) return false;
            }
            return true;
        };
        auto at = std::ranges::find_if(groups, same);
        if (at == groups.end()) {
            at = groups.insert(at, {row, {}});
        }
        at->value[row.cell.at("quantity")] = row.value();
    }
    return groups;
}

TEST(VolumeRadiance, ABlobThatAbsorbsNothingIsNotSeenUnderEvenLightFromAnySide) {
    const runtime::LightVector white = runtime::project_cubemap(
        std::vector<formats::Rgb>(formats::cubemap_texels(8), {1, 1, 1}), 8);
    for (const float g : {0.0f, 0.5f, 0.85f}) {
        const formats::Scene scene =
            tests::scene_of(tests::make_volume(tests::make_blob(0.5, 0.125), 6, 1, g));
        const Knobs knobs = fine_knobs();
        const formats::Volumes baked = tests::bake_volumes_of(scene, knobs);
        const runtime::VolumeLight lit = runtime::relight_volumes(baked.view(), white);
        const runtime::LitVolumes volumes = runtime::light_volumes(baked.view(), lit);
        // Walks are noise at a node: rays from all sides, beside the middle.
        std::mt19937 engine(1);
        std::normal_distribution<float> normal;
        constexpr int kRays = 400;
        double mean = 0;
        for (int i = 0; i < kRays; ++i) {
            const Vec3 along = normalize(Vec3{normal(engine), normal(engine), normal(engine)});
            const Vec3 aside{0.3f * normal(engine), 0.3f * normal(engine), 0.3f * normal(engine)};
            const runtime::MarchResult seen =
                runtime::march_volumes(volumes, {aside - 4.0f * along, along});
            mean += static_cast<double>(seen.radiance.g + seen.transmittance.g) / kRays;
        }
        EXPECT_NEAR(mean, 1, 0.02) << g;
    }
}

// Light that is scattered once on the way through the middle of a thin Gaussian ball of deviation
// s: L = sigma_s p(cosine) sqrt(2 pi) s for unit irradiance, dimmed by at most 2 %. The file's cut
// of the phase function does not show.
TEST(VolumeRadiance, AThinBlobUnderABeamShowsThePhaseFunctionAtAllAngles) {
    constexpr double kDeviation = 0.5, kSigmaS = 0.01;
    Knobs knobs = fine_knobs();
    knobs.set(kVolumeSpacing, 8);  // the light is the same everywhere
    for (const double g : {0.5, 0.85}) {
        const formats::Scene scene = tests::scene_of(
            tests::make_volume(tests::make_blob(kDeviation, kDeviation / 8),
                               static_cast<float>(kSigmaS), 1, static_cast<float>(g)));
        const formats::Volumes baked = tests::bake_volumes_of(scene, knobs);
        const Vec3 toward = formats::texel_direction(8, 2, 3, 1);
        const runtime::VolumeLight lit = runtime::relight_volumes(baked.view(), beam(toward, 8));
        const runtime::LitVolumes volumes = runtime::light_volumes(baked.view(), lit);
        const tests::CutPhase phase = tests::make_cut_phase(g);
        const Vec3 side = normalize(cross(toward, Vec3{1, 0.2f, 0.3f}));
        for (double angle = 0.02; angle < 3.14; angle += 0.02) {
            const Vec3 along = static_cast<float>(std::cos(angle)) * toward +
                               static_cast<float>(std::sin(angle)) * side;
            const runtime::MarchResult seen =
                runtime::march_volumes(volumes, {-6.0f * along, along});
            const double expected = kSigmaS * phase.whole(std::cos(angle)) *
                                    std::sqrt(2 * std::numbers::pi) * kDeviation;
            EXPECT_NEAR(static_cast<double>(seen.radiance.g) / expected, 0.99, 0.02)
                << "g " << g << ", angle " << angle;
        }
    }
}

TEST(VolumeRadiance, ABeamIsScatteredAsMonteCarloSays) {
    const std::vector<Group> groups = groups_of("radiance");
    ASSERT_FALSE(groups.empty());
    for (const Group& group : groups) {
        const double expected = group.value.at("order1") + group.value.at("order2plus");
        const double found = march(bake_row(group.row, fine_knobs()),
                                   beam(vector_of(group.row, "lx", "ly", "lz"), 8));
        EXPECT_NEAR(found, expected, 0.15 * expected) << group.row.id();
    }
}

}  // namespace
}  // namespace opaline::bake
