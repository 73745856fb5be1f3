#pragma once

#include "tests/formats/opal/emitter_fixture.h"

namespace opaline::tests {

/// Makes each vertex of `made` a copy of the one of `asset` that `source` names.
inline void take_vertices(const formats::Asset& asset, const std::vector<std::uint32_t>& source,
                          formats::Asset& made) {
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
}

/// The same asset with vertices that share rows: behind its own vertices, which no triangle uses
/// any more, each primitive has a copy of one for every corner of its triangles. `from`, if given:
/// becomes the vertex of `asset` that each vertex is a copy of.
inline formats::Asset with_copied_corners(const formats::Asset& asset,
                                          std::vector<std::uint32_t>* from = nullptr) {
    formats::Asset made = asset;
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
    take_vertices(asset, source, made);
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
    take_vertices(asset, source, made);
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

inline constexpr formats::Vec3 kCopyOffset{3, -1, 0.5f};

/// The same asset with two copies of its first primitive, of node 77. The second one stands behind
/// the first, whose vertices move its own on.
inline formats::Asset with_two_copies(formats::Asset asset) {
    for (int i = 0; i < 2; ++i) {
        formats::PrimitiveRecord record = asset.primitives[0];
        record.node = 77;
        record.first_vertex = static_cast<std::uint32_t>(asset.position.size());
        record.first_index = static_cast<std::uint32_t>(asset.index.size());
        record.vertex_count = record.index_count = 0;
        asset.copies.push_back(
            {static_cast<std::uint32_t>(asset.primitives.size()), 0, kCopyOffset, 0});
        asset.primitives.push_back(record);
        if (!asset.roughness.empty()) asset.roughness.push_back(asset.roughness[0]);
        if (!asset.gloss.empty()) asset.gloss.push_back(asset.gloss[0]);
        if (!asset.slots.empty()) asset.slots.offset.push_back(asset.slots.offset.back());
        if (!asset.added.count.empty()) asset.added.count.push_back(0);
    }
    return asset;
}

}  // namespace opaline::tests
