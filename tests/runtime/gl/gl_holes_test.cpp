// Surfaces that light passes in places: the same picture as on the CPU.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace opaline::runtime
