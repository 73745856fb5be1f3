#include "formats/opal/asset.h"

namespace opaline::formats {

AssetView Asset::view() const {
    AssetView view;
    view.provenance = provenance;
    view.cubemap_size = transport.cubemap_size;
    view.primitives = primitives;
    view.transport = transport.view();
    view.position = position;
    view.normal = normal;
    view.base_color = base_color;
    view.texcoord = texcoord;
    view.index = index;
    view.images.reserve(images.size());
    for (const PreviewImageData& image : images) {
        view.images.push_back({image.width, image.height, image.rgb});
    }
    return view;
}

}  // namespace opaline::formats
