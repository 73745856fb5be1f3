#include "formats/opal/asset.h"

#include <algorithm>

namespace opaline::formats {

AssetView Asset::view() const {
    AssetView view;
    view.provenance = provenance;
    view.cubemap_size = transport.cubemap_size;
    view.primitives = primitives;
    view.transport = transport.view();
    view.copies = copies;
    view.slots = slots.view();
    view.position = position;
    view.normal = normal;
    view.base_color = base_color;
    view.texcoord = texcoord;
    view.index = index;
    view.images.reserve(images.size());
    for (const PreviewImageData& image : images) {
        view.images.push_back({image.width, image.height, image.rgb});
    }
    view.roughness = roughness;
    view.openness = openness;
    view.gloss = gloss;
    view.holes = holes.view();
    view.added = added.view();
    view.normal_maps = normal_maps.view();
    view.volumes = volumes.view();
    view.clouds = clouds.view();
    view.emitters = emitters.view();
    return view;
}

const PrimitiveRecord& primitive_of(const AssetView& asset, std::uint32_t receiver) {
    return *std::upper_bound(asset.primitives.begin(), asset.primitives.end(), receiver,
                             [](std::uint32_t v, const PrimitiveRecord& p) {
                                 return v < p.first_vertex + p.vertex_count;
                             });
}

}  // namespace opaline::formats
