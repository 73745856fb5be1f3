#include "bake/encode/pack_asset.h"

#include <algorithm>
#include <utility>

#include "bake/scene/copies.h"
#include "bake/scene/lobe_record.h"
#include "bake/scene/marble.h"
#include "bake/scene/shared_rows.h"

namespace opaline::bake {
namespace {

using namespace formats;

Vec3 to_vec3(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

// `mapped`: this primitive has an image. `textured`: some primitive of the asset has one.
void append_vertices(Asset& asset, const Scene& scene, const Primitive& p, Rgb tint, bool mapped,
                     bool textured) {
    const Material& material = scene.materials[p.material];
    const Rgb base_color = material.base_color * tint;
    for (std::size_t v = 0; v < p.position.size(); ++v) {
        const glm::dvec3 world = scene.to_world(p.position[v]);
        asset.position.push_back(to_vec3(glm::vec3(world)));
        asset.normal.push_back(to_vec3(p.normal[v]));
        const Rgb plain = p.color.empty() ? base_color : base_color * p.color[v];
        asset.base_color.push_back(material.marble ? plain * marble_color(*material.marble, world)
                                                   : plain);
        if (textured) {
            asset.texcoord.push_back(mapped ? Float2{p.texcoord[v].x, p.texcoord[v].y} : Float2{});
        }
    }
}

// Of mixed vertices the mean of what others see.
std::vector<Openness> openness_of_vertices(const SlotsView& slots, std::vector<Openness> of_slots) {
    std::vector<Openness> of_vertices = spread_to_vertices(slots, of_slots);
    for (std::uint32_t v = 0; v < of_vertices.size(); ++v) {
        if (!slots.is_mixed(v)) continue;
        Vec3 axis{};
        float open = 0;
        for (std::size_t k = 0; k < std::size(slots.mix[v].slot); ++k) {
            const Openness& seen = of_slots[slots.mix[v].slot[k]];
            const float weight = static_cast<float>(slots.mix[v].weight[k]) / 255;
            axis = axis + weight * open_fraction(seen) * open_axis(seen);
            open += weight * open_fraction(seen);
        }
        of_vertices[v] = encode_openness(axis, open);
    }
    return of_vertices;
}

PreviewImageData to_preview(const Image8& image) {
    PreviewImageData preview{image.width, image.height, {}};
    preview.rgb.reserve(image.rgba.size() / 4 * 3);
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
        preview.rgb.insert(preview.rgb.end(),
                           {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
    }
    return preview;
}

}  // namespace

Asset pack_asset(const Scene& scene, std::span<const RowLayout> layouts, SparseRows transport,
                 std::vector<Openness> openness, Slots slots) {
    Asset asset;
    const bool textured = !scene.images.empty();
    std::uint32_t rows = 0, band_rows = 0;
    std::uint64_t codes = 0;
    for (std::size_t number = 0; number < scene.primitives.size(); ++number) {
        const Primitive& p = scene.primitives[number];
        const Material& material = scene.materials[p.material];
        const RowLayout& layout = layouts[p.material];
        PrimitiveRecord record;
        record.node = p.node;
        record.mesh = p.mesh;
        record.primitive = p.primitive;
        record.material = p.material;
        record.first_vertex = static_cast<std::uint32_t>(asset.position.size());
        record.vertex_count = static_cast<std::uint32_t>(p.position.size());
        record.first_index = static_cast<std::uint32_t>(asset.index.size());
        record.index_count = static_cast<std::uint32_t>(p.index.size());
        // Rows, band rows and codes are numbered consecutively over the primitives.
        const std::uint32_t count =
            count_receivers_of(scene, slots.view(), number) * layout.terms();
        record.first_row = rows;
        record.terms = layout.terms();
        record.bands = layout.bands();
        record.shading = layout.translucent ? Shading::translucent
                         : layout.sheet     ? Shading::sheet
                                            : Shading::diffuse;
        record.eta = layout.translucent ? material.medium->eta : 0.0f;
        record.first_band_row = band_rows;
        record.first_code = codes;
        rows += count;
        band_rows += count * record.bands;
        codes += std::uint64_t{transport.row_offset[record.first_row + count] -
                               transport.row_offset[record.first_row]} *
                 record.bands;
        const bool has_image = material.base_color_image != kNone ||
                               material.gloss.image != kNone || material.emission_image != kNone ||
                               material.normal_image != kNone;
        const bool mapped = has_image && !original_of(scene, number).texcoord.empty();
        if (mapped && material.base_color_image != kNone) {
            record.base_color_image = material.base_color_image;
            record.wrap_u = material.wrap_u;
            record.wrap_v = material.wrap_v;
        }
        record.flags =
            (material.double_sided || layout.sheet ? PrimitiveRecord::kDoubleSided : 0) |
            (layout.separate ? PrimitiveRecord::kSeparate : 0) |
            (layout.translucent && !layout.separate && !layout.constant && layout.harmonics > 0
                 ? PrimitiveRecord::kSingleOnly
                 : 0);
        if (!openness.empty()) {
            const bool in_medium = layout.mirrors && layout.translucent;
            asset.roughness.push_back(in_medium ? material.medium->roughness : kNotGlossy);
            asset.gloss.push_back(layout.mirrors && !layout.translucent
                                      ? make_lobe_record(material.gloss)
                                      : GlossRecord{});
        }
        asset.primitives.push_back(record);
        if (p.is_copy()) {
            asset.copies.push_back(
                {static_cast<std::uint32_t>(number), p.copy.primitive, to_vec3(p.copy.offset), 0});
        }
        append_vertices(asset, scene, p, layout.tint, mapped, textured);
        asset.index.insert(asset.index.end(), p.index.begin(), p.index.end());
    }
    for (const Image8& image : scene.images) {
        asset.images.push_back(to_preview(image));
    }
    for (const Primitive& p : scene.primitives) {
        asset.added.count.push_back(static_cast<std::uint32_t>(p.added.size()));
        asset.added.vertex.insert(asset.added.vertex.end(), p.added.begin(), p.added.end());
    }
    if (asset.added.vertex.empty()) asset.added = {};
    asset.holes = pack_holes(scene, asset.images);
    asset.normal_maps = pack_normal_maps(scene);
    if (std::none_of(asset.gloss.begin(), asset.gloss.end(),
                     [](const GlossRecord& g) { return g.is_glossy(); })) {
        asset.gloss.clear();
    }
    asset.openness = openness_of_vertices(slots.view(), std::move(openness));
    asset.slots = std::move(slots);
    asset.transport = std::move(transport);
    return asset;
}

}  // namespace opaline::bake
