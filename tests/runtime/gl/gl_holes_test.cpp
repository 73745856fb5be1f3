// Surfaces that light passes in places: the same picture as on the CPU.
// Normal maps on the GPU against the CPU: diffuse and glossy surfaces, plain, mirrored and bent
// ones.
#include <gtest/gtest.h>

#include "formats/opal/sheet_shares.h"
#include "tests/runtime/gl/gl_comparison.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using test::Gl;

// A whole floor under three sheets: a mask by an image, a blend by an image that repeats and by the
// alpha of its vertices, a blend without an image, thin-walled.
Asset asset_with_holes(bool has_vertex_alpha) {
    Asset asset = test::make_asset(8, 8);
    asset.images.push_back(test::make_noise_image(7, 5));
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, 4, 2), {});
    test::add_primitive(asset, test::make_sheet({-1.5f, 1, 0}, {0.7f, 0, 0}, {0, 0.7f, 0}, 2, 1),
                        {.bands = 3, .image = 0});
    test::add_primitive(asset, test::make_sheet({0, 1, -1}, {0.7f, 0, 0}, {0, 0.7f, 0}, 2, 3), {});
    test::add_primitive(asset, test::make_sheet({0.7f, 1, 0}, {0.7f, 0, 0}, {0, 0.7f, 0}, 1, 1),
                        {.is_sheet = true});
    using formats::HoleMode, formats::Wrap;
    asset.holes.record = {{.primitive = 1, .image = 0, .wrap_u = Wrap::clamp, .cutoff = 0.4f},
                          {.primitive = 2,
                           .image = 0,
                           .wrap_v = Wrap::mirror,
                           .alpha = 0.9f,
                           .mode = HoleMode::blend},
                          {.primitive = 3, .alpha = 0.6f, .mode = HoleMode::blend}};
    store_clear_share({0.7f, 1.5f}, asset.holes.record[2]);  // glass
    for (std::size_t v = 0; has_vertex_alpha && v < asset.position.size(); ++v) {
        asset.holes.vertex_alpha.push_back(0.2f + 0.1f * static_cast<float>(v % 9));
    }
    return asset;
}

TEST_F(Gl, HolesAgreeWithTheCpu) {
    const formats::Environment sky = tests::lat_long_map(64, 32, test::two_lights);
    const Camera camera{.eye = {0.5f, 2, 5}, .target = {0, 0.8f, 0}, .width = 160, .height = 120};
    std::vector<Picture> pictures;
    for (const bool has_vertex_alpha : {false, true}) {
        const Asset asset = asset_with_holes(has_vertex_alpha);
        test::BothRenderers both(asset, sky);
        both.expect_agreement(camera);
        pictures.push_back(both.on_cpu(camera));
    }
    EXPECT_NE(pictures[0].pixel, pictures[1].pixel);
}

using formats::Wrap;

// A floor, a ball, a mirrored sheet that is seen from behind, a translucent ball, and two
// thin-walled surfaces.
Asset asset_with_normal_maps(bool is_glossy) {
    Asset asset = test::make_asset(16, 8);
    asset.images.push_back(test::make_noise_image(7, 5));
    test::add_primitive(asset, test::make_sheet({0, 0, 0}, {4, 0, 0}, {0, 0, -4}, 4, 2), {});
    test::add_primitive(asset, test::make_sphere({-0.9f, 0.7f, 0}, 0.7f, 20, 12),
                        {.bands = 3, .image = 0});
    test::add_primitive(asset, test::make_sheet({1, 1, -1}, {0.7f, 0, 0}, {0, -0.7f, 0}, 2, 3),
                        {.is_double_sided = true});
    test::add_primitive(asset, test::make_sphere({0.9f, 0.5f, 0.5f}, 0.5f, 20, 12), {.eta = 1.4f});
    test::add_normal_map(asset, {.primitive = 0, .image = 0, .scale = 0.5f}, {1, 0, 0}, -1);
    test::add_normal_map(asset, {.primitive = 1, .image = 0, .wrap_u = Wrap::mirror, .scale = 0.8f},
                         {1, 0.1f, 0}, 1);
    test::add_normal_map(asset, {.primitive = 2, .image = 0, .wrap_v = Wrap::clamp}, {-1, 0, 0}, 1);
    test::add_normal_map(asset, {.primitive = 3, .image = 0, .scale = 0.3f}, {0, 1, 0}, 1);
    // Thin-walled: the eye sees the front of one and the back of the other.
    for (const std::uint32_t p : {4u, 5u}) {
        const float side = p == 4 ? 1.0f : -1.0f;
        test::add_primitive(asset,
                            test::make_sheet({-0.4f - 0.7f * side, 1.7f, -0.5f},
                                             {side * 0.5f, 0, 0.2f}, {0, 0.3f, 0}, 2, 2),
                            {.bands = 3, .is_double_sided = true, .is_sheet = true});
        // The rows of the back, which are negative, are turned over.
        const formats::RowRange rows = asset.view().rows_of(p);
        for (std::uint32_t row = 1; row < rows.rows; row += 2) {
            for (std::uint32_t band = 0; band < rows.bands; ++band) {
                const std::size_t at = rows.first_band_row + std::size_t{row} * rows.bands + band;
                asset.transport.average_scale[at] *= -1;
                asset.transport.detail_scale[at] *= -1;
            }
        }
        formats::NormalMapRecord map{.primitive = p, .image = 0, .scale = 0.6f};
        formats::store_sheet_shares({{0.5f, 0.4f, 0.3f}, {0.2f, 0.4f, 0.6f}}, map);
        test::add_normal_map(asset, map, {1, 0, 0}, 1);
    }
    if (is_glossy) {
        asset.roughness.assign(6, formats::kNotGlossy);
        asset.roughness[3] = 0.3f;
        asset.gloss.resize(6);
        asset.gloss[0] = {.roughness = 0.4f, .f0 = {0.04f, 0.04f, 0.04f}, .f90 = 1};
        asset.gloss[1] = {.metallic = 0.7f, .roughness = 0.6f, .f0 = {0.1f, 0.1f, 0.1f}, .f90 = 1};
        asset.gloss[2] = {.roughness = 0.5f, .f0 = {0.2f, 0.2f, 0.2f}, .f90 = 1};
        for (const formats::Vec3 normal : asset.normal) {
            asset.openness.push_back(formats::encode_openness(normal, 0.8f));
        }
    }
    return asset;
}

TEST_F(Gl, NormalMapsAgreeWithTheCpu) {
    formats::Environment sky = tests::lat_long_map(64, 32, test::two_lights);
    sky.discs.push_back({normalize(formats::Vec3{0.5f, 1, 0.4f}), 0.01f, {6000, 5000, 4000}});
    const Camera camera{.eye = {0.5f, 2, 5}, .target = {0, 0.6f, 0}, .width = 72, .height = 54};
    for (const bool is_glossy : {false, true}) {
        Asset asset = asset_with_normal_maps(is_glossy);
        test::BothRenderers both(asset, sky, rotation_about_y(0.7f));
        both.expect_agreement(camera);
        const Picture mapped = both.on_cpu(camera);
        asset.normal_maps = {};
        EXPECT_NE(mapped.pixel, both.on_cpu(camera).pixel);
    }
}

}  // namespace

}  // namespace opaline::runtime
