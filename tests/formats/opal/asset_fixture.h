#pragma once

#include <random>

#include "formats/opal/asset.h"
#include "formats/opal/cubemap.h"

namespace opaline::tests {

/// Random rows for `step`: each `step`-th coefficient from `first` on is there, values from `low`.
inline formats::SparseRow make_random_row(std::uint32_t bands, std::uint32_t first,
                                          std::uint32_t step, float low, std::mt19937& generator) {
    std::uniform_real_distribution<float> uniform(0.0f, 1.0f);
    formats::SparseRow row;
    row.bands = bands;
    for (std::uint32_t k = first; k < formats::cubemap_texels(8); k += step) {
        if (k % 64 != 0) row.index.push_back(k);
    }
    for (std::size_t i = 0; i < row.index.size() * bands; ++i) {
        row.value.push_back(uniform(generator) - 0.5f);
    }
    for (std::size_t i = 0; i < bands * std::size_t{6}; ++i) {
        row.average.push_back(uniform(generator) + low);
    }
    return row;
}

/// Adds `record`, whose counts and bands are set, where the asset's arrays end.
inline void add_primitive(formats::Asset& asset, formats::PrimitiveRecord record) {
    record.first_vertex = static_cast<std::uint32_t>(asset.position.size());
    record.first_index = static_cast<std::uint32_t>(asset.index.size());
    record.first_row = asset.transport.view().rows();
    record.first_band_row = static_cast<std::uint32_t>(asset.transport.detail_scale.size());
    record.first_code = asset.transport.code8.size() + asset.transport.code16.size();
    asset.primitives.push_back(record);
}

inline void add_vertex(formats::Asset& asset, formats::Vec3 position, formats::Rgb color,
                       formats::Float2 texcoord) {
    asset.position.push_back(position);
    asset.normal.push_back({0, 0, 1});
    asset.base_color.push_back(color);
    asset.texcoord.push_back(texcoord);
}

/// A small sound asset: a grey primitive and a textured RGB one, n = 8.
inline formats::Asset make_small_asset(std::uint32_t code_bits = 8) {
    using namespace formats;
    std::mt19937 generator(7);
    Asset asset;
    asset.provenance = R"({"generator":"test"})";
    asset.transport = make_sparse_rows(8, code_bits);
    asset.images.push_back({2, 2, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}});
    for (std::uint32_t p = 0; p < 2; ++p) {
        PrimitiveRecord record;
        record.bands = p == 0 ? 1 : 3;
        record.vertex_count = 4;
        record.index_count = 6;
        record.base_color_image = p == 0 ? kNoImage : 0;
        add_primitive(asset, record);
        for (std::uint32_t v = 0; v < 4; ++v) {
            const float x = static_cast<float>(v & 1u), y = static_cast<float>(v >> 1u);
            add_vertex(asset, {x, y, static_cast<float>(p)}, {0.5f, 0.6f, 0.7f}, {x, y});
            append_row(asset.transport, make_random_row(record.bands, 1, 3 + v, 0, generator));
        }
        asset.index.insert(asset.index.end(), {0u, 1u, 2u, 1u, 3u, 2u});
    }
    return asset;
}

/// Adds a translucent triangle of three vertices, `terms` random rows each; n = 8.
inline void add_translucent_triangle(formats::Asset& asset, std::uint32_t terms, float eta,
                                     bool is_separate = false, std::uint32_t bands = 3) {
    using namespace formats;
    std::mt19937 generator(8);
    PrimitiveRecord record;
    record.shading = Shading::translucent;
    record.terms = terms;
    record.bands = bands;
    record.flags = is_separate ? PrimitiveRecord::kSeparate : 0;
    record.eta = eta;
    record.vertex_count = record.index_count = 3;
    add_primitive(asset, record);
    for (std::uint32_t v = 0; v < 3; ++v) {
        add_vertex(asset, {static_cast<float>(v == 1), static_cast<float>(v == 2), 0}, {1, 1, 1},
                   {0, 0});
        asset.index.push_back(v);
        for (std::uint32_t k = 0; k < terms; ++k) {
            append_row(asset.transport, make_random_row(bands, 1 + k, 5 + v, -0.5f, generator));
        }
    }
}

/// Adds a thin-walled triangle: two random rows a vertex.
inline void add_sheet_triangle(formats::Asset& asset, std::uint32_t bands = 3) {
    add_translucent_triangle(asset, 2, 0, false, bands);
    asset.primitives.back().shading = formats::Shading::sheet;
}

/// Makes translucent primitives glossy: roughness 0.3, openness from closed to open along the
/// vertices.
inline void add_gloss(formats::Asset& asset) {
    using namespace formats;
    for (const PrimitiveRecord& p : asset.primitives) {
        asset.roughness.push_back(p.shading == Shading::translucent ? 0.3f : kNotGlossy);
    }
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        const float open = static_cast<float>(v) / static_cast<float>(asset.position.size() - 1);
        asset.openness.push_back(encode_openness({0.2f, 0, 1}, open));
    }
}

/// Makes opaque primitives glossy: a textured metal and a plain dielectric in turn.
inline void add_opaque_gloss(formats::Asset& asset) {
    using namespace formats;
    if (asset.roughness.empty()) add_gloss(asset);
    for (std::size_t p = 0; p < asset.primitives.size(); ++p) {
        GlossRecord gloss;
        if (asset.primitives[p].shading == Shading::diffuse) {
            gloss.metallic = p % 2 == 0 ? 1.0f : 0.0f;
            gloss.roughness = 0.25f + 0.5f * gloss.metallic;
            gloss.f0 = {0.04f, 0.05f, 0.06f};
            gloss.f90 = 0.5f;
            gloss.image = p % 2 == 0 ? 0 : kNoImage;
            gloss.wrap_v = Wrap::mirror;
        }
        asset.gloss.push_back(gloss);
    }
}

}  // namespace opaline::tests
