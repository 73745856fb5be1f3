#pragma once

#include "tests/formats/opal/emitter_fixture.h"

namespace opaline::tests {

/// The same asset with vertices that share rows: behind its own vertices, which no triangle uses
/// any more, each primitive has a copy of one for every corner of its triangles. `from`, if given:
/// becomes the vertex of `asset` that each vertex is a copy of.
inline formats::Asset with_copied_corners(const formats::Asset& asset,
                                          std::vector<std::uint32_t>* from = nullptr) {
    formats::Asset made = asset;
    made.position.clear();
    made.slots.offset = {0};
    std::vector<std::uint32_t> source;
    for (formats::PrimitiveRecord& p : made.primitives) {
        const std::uint32_t first = p.first_vertex, count = p.vertex_count;
        const auto here = static_cast<std::uint32_t>(source.size());
        for (std::uint32_t v = 0; v < count; ++v) {
            made.slots.slot.push_back(made.slots.offset.back() + v);
            made.slots.vertex.push_back(here + v);
            source.push_back(first + v);
        }
        for (std::uint32_t i = p.first_index; i < p.first_index + p.index_count; ++i) {
            const std::uint32_t corner = asset.index[i];
            made.index[i] = static_cast<std::uint32_t>(source.size()) - here;
            made.slots.slot.push_back(made.slots.offset.back() + corner);
            source.push_back(first + corner);
        }
        made.slots.offset.push_back(static_cast<std::uint32_t>(made.slots.vertex.size()));
        p.first_vertex = here;
        p.vertex_count = static_cast<std::uint32_t>(source.size()) - here;
    }
    const auto copy = [&](const auto& values, auto& out) {
        out.clear();
        for (std::size_t i = 0; i < source.size() && !values.empty(); ++i) {
            out.push_back(values[source[i]]);
        }
    };
    copy(asset.position, made.position);
    copy(asset.normal, made.normal);
    copy(asset.base_color, made.base_color);
    copy(asset.texcoord, made.texcoord);
    copy(asset.openness, made.openness);
    copy(asset.holes.vertex_alpha, made.holes.vertex_alpha);
    copy(asset.normal_maps.tangent, made.normal_maps.tangent);
    if (from != nullptr) *from = std::move(source);
    return made;
}

/// `make_emitter_asset` and a translucent triangle, with copied corners.
inline formats::Asset make_shared_asset() {
    formats::Asset asset = make_small_asset();
    add_translucent_triangle(asset, 4, 1.3f);
    add_emitters(asset);
    return with_copied_corners(asset);
}

}  // namespace opaline::tests
