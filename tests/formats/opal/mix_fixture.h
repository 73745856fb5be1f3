#pragma once

#include "tests/formats/opal/emitter_fixture.h"

namespace opaline::tests {

/// The same asset with vertices that have no rows: behind its own vertices, each primitive of
/// diffuse shading has one for each of its triangles, which takes the place of the triangle's first
/// corner. `asset`: without slots.
inline formats::Asset with_mixed_vertices(const formats::Asset& asset) {
    formats::Asset made = asset;
    std::vector<std::uint32_t> source;
    formats::Slots& slots = made.slots;
    slots.offset = {0};
    for (formats::PrimitiveRecord& p : made.primitives) {
        const std::uint32_t first = p.first_vertex, count = p.vertex_count,
                            offset = slots.offset.back();
        p.first_vertex = static_cast<std::uint32_t>(source.size());
        for (std::uint32_t v = 0; v < count; ++v) {
            const std::uint32_t slot = offset + v;
            slots.vertex.push_back(static_cast<std::uint32_t>(source.size()));
            slots.slot.push_back(slot);
            slots.mix.push_back({{slot, slot, slot}, {255, 0, 0, 0}});
            source.push_back(first + v);
        }
        for (std::uint32_t i = 0; i < p.index_count && p.shading == formats::Shading::diffuse;
             i += 3) {
            const std::uint32_t* const corner = &asset.index[p.first_index + i];
            made.index[p.first_index + i] =
                static_cast<std::uint32_t>(source.size()) - p.first_vertex;
            slots.slot.push_back(offset + corner[0]);
            slots.mix.push_back(
                {{offset + corner[0], offset + corner[1], offset + corner[2]}, {120, 100, 35, 0}});
            source.push_back(first + corner[0]);
        }
        p.vertex_count = static_cast<std::uint32_t>(source.size()) - p.first_vertex;
        slots.offset.push_back(static_cast<std::uint32_t>(slots.vertex.size()));
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
    for (std::uint32_t v = 0; v < source.size(); ++v) {
        slots.place.push_back(v);
    }
    return made;
}

/// `make_emitter_asset` and a translucent triangle, with mixed vertices.
inline formats::Asset make_mixed_asset() {
    formats::Asset asset = make_small_asset();
    add_translucent_triangle(asset, 4, 1.3f);
    add_emitters(asset);
    return with_mixed_vertices(asset);
}

}  // namespace opaline::tests
