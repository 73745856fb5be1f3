#include "tests/runtime/picture/every_surface.h"

#include <cmath>

#include "formats/opal/sheet_shares.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::test {
namespace {

using formats::Asset;
using formats::Rgb;
using formats::Wrap;

void add_surfaces(Asset& asset) {
    asset.images = {make_noise_image(13, 9), make_noise_image(7, 5)};
    add_primitive(asset, make_sheet({0, 0, 0}, {5, 0, 0}, {0, 0, -5}, 3, 1), {});
    for (const float x : {-2.2f, -1.1f, 0.0f}) {
        add_primitive(asset, make_sphere({x, 0.5f, 1}, 0.5f, 20, 14), {.bands = 3});
    }
    add_primitive(asset, make_sphere({1.1f, 0.5f, 1}, 0.5f, 20, 14),
                  {.bands = 3, .eta = 1.3f, .terms = 25});
    add_primitive(asset, make_sphere({2.2f, 0.5f, 1}, 0.5f, 20, 14), {.eta = 1.4f, .terms = 4});
    add_primitive(asset, make_sphere({-2, 0.7f, -1}, 0.7f, 20, 14),
                  {.bands = 3, .eta = 1.2f, .terms = 10, .is_separate = true});
    add_primitive(asset, make_sheet({0, 1, -1}, {0.7f, 0, 0.2f}, {0, 0.8f, 0.1f}, 4, 1.8f),
                  {.bands = 3, .image = 0, .is_double_sided = true, .is_sheet = true});
    add_primitive(asset, make_sheet({2, 1, -1}, {0.7f, 0, 0}, {0, 0.8f, 0}, 2, 1), {.bands = 3});
    add_primitive(asset, make_sheet({2, 1, -2}, {0.7f, 0, 0}, {0, 0.8f, 0}, 2, 3),
                  {.image = 0, .wrap_u = Wrap::clamp, .is_double_sided = true});
}

void add_gloss(Asset& asset) {
    asset.roughness.assign(asset.primitives.size(), formats::kNotGlossy);
    asset.roughness[5] = 0.3f;
    asset.gloss.assign(asset.primitives.size(), {});
    const std::size_t glossy[] = {1, 2, 3, 9};
    const float roughness[] = {0.15f, 0.45f, 0.9f, 0.8f}, metallic[] = {1, 0, 1, 1};
    for (std::size_t i = 0; i < 4; ++i) {
        formats::GlossRecord& gloss = asset.gloss[glossy[i]];
        gloss.f0 = {0.04f, 0.05f, 0.06f};
        gloss.f90 = 0.9f;
        gloss.metallic = metallic[i];
        gloss.roughness = roughness[i];
    }
    asset.gloss[9].image = 1;
    asset.gloss[9].wrap_u = Wrap::mirror;
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        const auto t = static_cast<float>(v);
        const formats::Vec3 tilt{std::sin(t), std::sin(2 * t), std::cos(3 * t)};
        asset.openness.push_back(formats::encode_openness(asset.normal[v] + 0.3f * tilt,
                                                          0.8f + 0.4f * std::sin(0.3f * t)));
    }
}

void add_holes(Asset& asset) {
    using formats::HoleMode;
    asset.holes.record = {{.primitive = 7, .alpha = 0.8f, .mode = HoleMode::blend},
                          {.primitive = 8, .image = 1, .wrap_v = Wrap::mirror, .cutoff = 0.4f}};
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        asset.holes.vertex_alpha.push_back(0.7f + 0.1f * static_cast<float>(v % 3));
    }
}

void add_lamps(Asset& asset) {
    append_emitter(asset.emitters, "a");
    append_emitter(asset.emitters, "b");
    for (const std::uint32_t p : {0u, 4u, 7u}) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        std::vector<Rgb> rows;
        for (std::uint32_t i = 0; i < primitive.vertex_count * primitive.terms; ++i) {
            rows.push_back(
                {0.1f * static_cast<float>(i % 5), 0.05f * static_cast<float>(i % 3), 0.1f});
        }
        append_block(asset.emitters, p % 2 == 0 ? 0 : 1, p, rows);
    }
    asset.emitters.own = {{8, 0, {0.5f, 0.2f, 0.1f}, 0, Wrap::repeat, Wrap::mirror},
                          {9, 1, {0.1f, 0.1f, 0.4f}}};
}

void add_normal_maps(Asset& asset) {
    add_normal_map(asset, {.primitive = 0, .image = 1, .scale = 0.4f}, {1, 0, 0}, -1);
    add_normal_map(asset, {.primitive = 2, .image = 1, .wrap_u = Wrap::mirror, .scale = 0.5f},
                   {1, 0, 0.2f}, 1);
    add_normal_map(asset, {.primitive = 5, .image = 0, .scale = 0.2f}, {0, 0, 1}, 1);
    formats::NormalMapRecord sheet{.primitive = 7, .image = 1, .scale = 0.4f};
    formats::store_sheet_shares({{0.5f, 0.4f, 0.3f}, {0.2f, 0.4f, 0.6f}}, sheet);
    add_normal_map(asset, sheet, {1, 0, 0}, 1);
}

}  // namespace

Asset make_every_surface() {
    Asset asset = make_asset(16, 8);
    add_surfaces(asset);
    add_gloss(asset);
    add_holes(asset);
    add_lamps(asset);
    add_normal_maps(asset);
    return asset;
}

}  // namespace opaline::test
