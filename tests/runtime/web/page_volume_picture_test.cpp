// What pages show of volumes, in a headless browser.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/runtime/picture/synthetic_asset.h"
#include "tests/runtime/volumes/glow_support.h"
#include "tests/runtime/volumes/synthetic_volume.h"
#include "tests/runtime/web/page_comparison.h"

namespace opaline::runtime {
namespace {

using test::expect_same_pixels;
using test::page_of;
using test::PagePicture;
using test::PageView;
using test::render_on_cpu;

// Smoke of that many terms, 1.6 m wide, denser on one side; each node has rows of its own.
test::TestVolume make_smoke(std::uint32_t single, std::uint32_t multiple, std::uint32_t bands) {
    test::TestVolume smoke;
    smoke.first_brick = {-2, -2, -2};
    smoke.extent = {4, 4, 4};
    smoke.to_world = {0.05f, 0.01f, 0, 0.2f, 0, 0.05f, 0, 0.8f, 0.01f, 0, -0.05f, 0};
    smoke.sigma_t = {1, 2, 4};
    smoke.albedo = {0.9f, 0.8f, 0.7f};
    smoke.spacing = 4;
    smoke.single_terms = single;
    smoke.multiple_terms = multiple;
    smoke.bands = bands;
    test::scatter_forward(smoke, 0.7);
    smoke.density = [](float x, float y, float z) {
        return std::max(0.0f, 1 + 0.03f * x - (x * x + y * y + z * z) / 220);
    };
    smoke.rows = [multiple, bands](formats::NodeVoxel node) {
        std::vector<formats::SparseRow> rows;
        for (std::uint32_t k = 0; k <= multiple; ++k) {
            const auto at = static_cast<float>(node[0] + 2 * node[1] - node[2]) * 0.1f;
            const float size = k < 2 ? 0.5f : 0.1f;
            rows.push_back(test::constant_row(8, size * (1 + 0.3f * std::sin(at)), bands));
            rows.back().index = {9, 200, 331};
            rows.back().value.assign(std::size_t{3} * bands, size * std::cos(at));
        }
        return rows;
    };
    return smoke;
}

Camera camera_at_smoke(const formats::Asset& asset, std::uint32_t width, std::uint32_t height) {
    const formats::Vec3 eye{0.7f, 1, 4};
    return {.eye = eye,
            .target = {0, 0.7f, 0},
            .fov_y = 32,
            .width = width,
            .height = height,
            .near_plane = near_plane_for(asset.view(), eye)};
}

// Two volumes that overlap, one that scatters a sun forward and burns in one brick of eight; a
// sheet cuts them.
TEST_F(PagePicture, VolumesAndTheirFireLookAsOnTheCpuUnderASunBehindThemInTheSlidersColour) {
    formats::Asset asset = test::make_asset(8, 16);
    formats::append_emitter(asset.emitters, "lamp");
    formats::append_emitter(asset.emitters, "fire");
    asset.volumes = test::make_volumes(8);
    const test::TestVolume burning = make_smoke(25, 4, 1);
    test::TestVolume other = make_smoke(0, 1, 3);
    other.to_world[3] = -0.8f;
    test::add_volume(asset.volumes, other);
    test::add_volume(asset.volumes, burning);
    test::add_glow(asset.volumes, burning,
                   [](float x, float y, float z) {
                       const float r2 = (x - 2) * (x - 2) + (y - 2) * (y - 2) + (z - 2) * (z - 2);
                       return std::exp(-r2 / 12) * formats::Rgb{60, 20, 10};
                   },
                   {0.3f, 0.2f, 0.1f});
    asset.volumes.glow.record.back().emitter = 1;
    test::add_primitive(
        asset, test::make_sheet({0, 0.6f, 0.1f}, {0.5f, 0, 0.4f}, {0, 0.4f, 0.2f}, 2, 1), {});
    formats::Environment sky = tests::lat_long_map(64, 32, test::two_lights);
    sky.discs.push_back({normalize(formats::Vec3{-0.4f, 0.2f, -1}), 0.01f, {4e4f, 3e4f, 1e4f}});
    const PageLight lights[] = {{"sky", sky}};
    PageView wanted{"eye=0.7,1,4&target=0,0.7,0&rotate=20&exposure=-2&emitter=fire%3D0.5,1,3",
                    20,
                    -2,
                    {{1, 1, 1}, {0.5f, 1, 3}}};
    const auto cpu = [&](const Camera& moved) {
        return render_on_cpu(asset.view(), sky, moved, wanted);
    };
    const Camera camera = camera_at_smoke(asset, 80, 60);
    expect_same_pixels(page_of(asset, lights), wanted.address, camera, cpu);
    const DisplayPicture lit = cpu(camera);
    wanted.emitters[1] = {};
    const DisplayPicture dark = cpu(camera);
    int of_fire = 0;
    for (std::size_t i = 0; i < lit.rgba.size(); ++i) {
        of_fire = std::max(of_fire, lit.rgba[i] - dark.rgba[i]);
    }
    EXPECT_GT(of_fire, 40);
}

}  // namespace
}  // namespace opaline::runtime
