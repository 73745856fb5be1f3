#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/embed_gl/volume_textures.h"
#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"
#include "tests/runtime/volumes/glow_support.h"
#include "tests/runtime/volumes/synthetic_volume.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Rgb;
using formats::TermSet;
using test::BothRenderers;
using test::Gl;

constexpr std::uint32_t kSize = 8;

// Different at each node, in each direction and band.
formats::SparseRow varied_row(formats::NodeVoxel node, std::uint32_t k, std::uint32_t bands) {
    const float at = 0.3f * static_cast<float>(node[0]) + 0.2f * static_cast<float>(node[1]) -
                     0.1f * static_cast<float>(node[2]) + static_cast<float>(k);
    const float mean = (k < 2 ? 0.6f : 0.1f) + 0.2f * std::sin(at);
    formats::SparseRow row = test::constant_row(kSize, mean, bands);
    row.index = {1, 2 * kSize * kSize + 1, 5 * kSize * kSize + kSize};
    for (std::size_t i = 0; i < row.index.size() * bands; ++i) {
        row.value.push_back(0.8f * std::cos(at + static_cast<float>(i)));
    }
    return row;
}

// About 1.6 m wide around the origin, with hollows, a missing brick and one at a table's edge.
test::TestVolume smoke(std::uint32_t spacing, std::uint32_t single, std::uint32_t multiple,
                       std::uint32_t bands = 1) {
    test::TestVolume volume;
    volume.first_brick = {-2, -2, -2};
    volume.extent = {4, 4, 4};
    volume.to_world = {0.05f, 0, 0, 0, 0, 0.05f, 0, 0, 0, 0, 0.05f, 0};
    volume.sigma_t = {1, 2, 4};
    volume.albedo = {0.9f, 0.8f, 0.7f};
    volume.spacing = spacing;
    volume.single_terms = single;
    volume.multiple_terms = multiple;
    volume.bands = bands;
    volume.moment = {1, 0.6f, 0.4f, 0.2f, 0.1f};
    volume.density = [](float x, float y, float z) {
        const float bumps = 1 + 0.4f * std::sin(0.7f * x) * std::cos(0.5f * y) * std::sin(0.6f * z);
        const float ball = std::max(0.0f, 1 - (x * x + y * y + z * z) / 220);
        return x > 0 && y < -4 && z > 4 ? 0 : bumps * ball;
    };
    volume.rows = [multiple, bands](formats::NodeVoxel node) {
        std::vector<formats::SparseRow> rows;
        for (std::uint32_t k = 0; k < 1 + multiple; ++k) {
            rows.push_back(varied_row(node, k, bands));
        }
        return rows;
    };
    return volume;
}

// Sheared, stretched and moved.
test::TestVolume slanted() {
    test::TestVolume volume = smoke(4, 4, 1, 3);
    volume.to_world = {0.06f, 0.02f, 0, 0.3f, 0, 0.03f, 0.01f, 0.1f, 0.01f, 0, -0.08f, -0.2f};
    volume.sigma_t = {3, 2, 1};
    return volume;
}

Asset volumes_alone(const std::vector<test::TestVolume>& volumes) {
    Asset asset = test::make_asset(kSize, 16);
    asset.volumes = test::make_volumes(kSize);
    for (const test::TestVolume& volume : volumes) {
        test::add_volume(asset.volumes, volume);
    }
    return asset;
}

// With a tilted sheet that cuts through the middle.
Asset volumes_and_sheet(const std::vector<test::TestVolume>& volumes) {
    Asset asset = volumes_alone(volumes);
    test::add_primitive(asset,
                        test::make_sheet({0, 0, 0.1f}, {0.5f, 0, 0.4f}, {0, 0.4f, 0.2f}, 2, 1),
                        {.bands = 1, .details = 20});
    return asset;
}

Camera camera() {
    return {.eye = {0.7f, 0.6f, 3.5f}, .fov_y = 35, .width = 60, .height = 46, .near_plane = 0.1f};
}

const formats::Environment kSky = tests::lat_long_map(64, 32, test::two_lights);

// A small light besides, seen from the camera a little beside the volumes.
formats::Environment sunny() {
    formats::Environment sky = kSky;
    sky.discs.push_back({formats::normalize({-0.4f, 0.1f, -1}), 0.01f, {4e4f, 3e4f, 1e4f}});
    return sky;
}

void expect_agreement(const Asset& asset, const Camera& camera, const GlRenderOptions& options = {},
                      const formats::Environment& sky = kSky) {
    BothRenderers(asset, sky).expect_agreement(camera, options);
}

// What a bake makes of Henyey-Greenstein functions, two in one picture: each has its own table.
TEST_F(Gl, ForwardVolumesAgreeUnderASun) {
    const auto forward = [](test::TestVolume volume, double g) {
        test::scatter_forward(volume, g);
        volume.sigma_t = 0.3f * volume.sigma_t;
        return volume;
    };
    const test::TestVolume near = forward(smoke(8, 25, 9), 0.85);
    const test::TestVolume far = forward(slanted(), 0.5);
    const LightVector light = project_environment(sunny(), kSize);
    const Asset asset = volumes_alone({smoke(8, 1, 1), near, far});
    const VolumeLight lit = relight_volumes(asset.view().volumes, light);
    ASSERT_EQ(lit.part[0].suns, 0u);
    ASSERT_GT(lit.part[1].suns, 0u);
    ASSERT_GT(lit.part[2].suns, 0u);
    expect_agreement(asset, camera(), {.background = false}, sunny());
    expect_agreement(volumes_and_sheet({near}), camera(), {}, sunny());
    BothRenderers both(asset, sunny());
    for (const TermSet terms : {TermSet::volume_multiple, TermSet::volume_single}) {
        both.expect_agreement(camera(), {.terms = terms, .background = false});
    }
}

TEST_F(Gl, VolumesAloneAgreeForEverySpacingAndNumberOfTerms) {
    for (const auto& volume :
         {smoke(8, 25, 9), smoke(8, 16, 0, 3), smoke(4, 9, 16), smoke(2, 4, 4, 3), smoke(1, 1, 1),
          smoke(8, 0, 25), smoke(4, 0, 0)}) {
        SCOPED_TRACE(testing::Message() << "spacing " << volume.spacing << ", terms "
                                        << volume.single_terms << " and " << volume.multiple_terms);
        expect_agreement(volumes_alone({volume}), camera());
    }
}

TEST_F(Gl, ASheetInsideAVolumeCutsItAsOnTheCpu) {
    const Asset asset = volumes_and_sheet({smoke(4, 9, 4)});
    expect_agreement(asset, camera(), {.supersampling = 1, .background = true});
    expect_agreement(asset, camera(), {.supersampling = 3, .background = false});
}

TEST_F(Gl, OverlappingAndSlantedVolumesAgree) {
    expect_agreement(volumes_alone({slanted()}), camera());
    expect_agreement(volumes_alone({smoke(8, 9, 4), slanted()}), camera(), {.background = false});
    expect_agreement(volumes_and_sheet({slanted(), smoke(2, 1, 0), smoke(8, 4, 0, 3)}), camera());
}

TEST_F(Gl, VolumesAgreeFromInsideAndAtAnyScale) {
    Camera inside = camera();
    inside.eye = {0.1f, 0.05f, 0.2f};
    inside.target = {-1, 0.3f, -0.4f};
    inside.fov_y = 80;
    inside.near_plane = 1e-3f;
    expect_agreement(volumes_and_sheet({smoke(8, 9, 4)}), inside);
    for (const float scale : {1e-9f, 1e9f}) {
        test::TestVolume volume = slanted();
        for (float& entry : volume.to_world) {
            entry *= scale;
        }
        volume.sigma_t = 1 / scale * volume.sigma_t;
        const Asset asset = volumes_alone({volume});
        expect_agreement(asset, frame_asset(asset.view(), 40, 60, 50));
    }
}

TEST_F(Gl, TermsOfVolumesAreShownApart) {
    const Asset asset = volumes_and_sheet({smoke(8, 9, 4), slanted()});
    BothRenderers both(asset, kSky);
    for (const TermSet terms :
         {TermSet::volume_single, TermSet::diffuse, TermSet::volume_multiple | TermSet::diffuse}) {
        both.expect_agreement(camera(), {.terms = terms, .background = false});
    }
}

TEST_F(Gl, LightOfVolumesAgrees) {
    Asset asset = volumes_alone({smoke(8, 9, 4)});
    const auto flame = [](float x, float y, float z) {
        const float r2 = (x - 3) * (x - 3) + (y + 2) * (y + 2) + (z - 4) * (z - 4);
        return std::exp(-r2 / 20) * Rgb{30, 10, 2};
    };
    formats::append_emitter(asset.emitters, "flame");
    test::add_glow(asset.volumes, smoke(8, 9, 4), flame, {0.5f, 0.3f, 0.1f});
    // Beside a volume that is dark.
    test::add_volume(asset.volumes, slanted());
    BothRenderers both(asset, kSky);
    for (const Rgb color : {Rgb{1, 1, 1}, Rgb{0, 2, 0.5f}, Rgb{}}) {
        const std::array<Rgb, 1> colors{color};
        both.set_emitters({colors});
        both.expect_agreement(camera(), {.background = false});
    }
}

TEST_F(Gl, VolumesDoNotDependOnTiles) {
    const Asset asset = volumes_and_sheet({smoke(8, 9, 4)});
    BothRenderers both(asset, kSky);
    test::expect_same_picture(both.on_gl(camera()), both.on_gl(camera(), {.max_tile_samples = 96}));
}

TEST_F(Gl, WithoutALightVolumesOnlyAbsorb) {
    const Asset asset = volumes_alone({smoke(8, 4, 4)});
    auto renderer = GlRenderer::create(asset.view(), kSky);
    ASSERT_TRUE(renderer.has_value());
    const auto black = renderer->render(camera(), {.background = false});
    const auto sky = renderer->render(camera());
    ASSERT_TRUE(black && sky);
    EXPECT_TRUE(std::ranges::all_of(black->pixel, [](Rgb c) { return c == Rgb{}; }));
    EXPECT_LT(sky->pixel[sky->pixel.size() / 2 + 30].b, 0.3f * sky->pixel[0].b);
}

TEST_F(Gl, DamagedVolumesNeverReachThePicture) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    Asset asset = volumes_alone({smoke(8, 9, 4), slanted()});
    asset.volumes.rows.average_scale[3] = nan;
    asset.volumes.rows.average_scale[7] = 3e38f;
    asset.volumes.density_scale[1] = 3e38f;
    asset.volumes.density_scale[2] = nan;
    asset.volumes.phase[100] = nan;
    asset.volumes.phase[150] = 3e38f;
    asset.volumes.phase[formats::kPhaseEntries + 9] = -1;
    asset.volumes.records[1].to_world = {1e-30f, 0, 0, 0, 0, 1e-30f, 0, 0, 0, 0, 1e-30f, 0};
    test::expect_displayable(BothRenderers(asset, sunny()).on_gl(camera()));
}

TEST_F(Gl, VolumesBeyondTheLimitsAreRefusedWithTheReason) {
    const auto too_many = GlRenderer::create(
        volumes_alone(std::vector(kMaxGlVolumes + 1, smoke(8, 0, 0))).view(), kSky);
    ASSERT_FALSE(too_many.has_value());
    EXPECT_EQ(too_many.error().kind, formats::ErrorKind::resource);
}

}  // namespace
}  // namespace opaline::runtime
