#include "formats/media/load_clouds.h"

#include <algorithm>
#include <utility>

#include "formats/opal/clouds.h"

namespace opaline::formats {
namespace {

CloudLayer load_layer(const CloudEntry& entry, CloudDetail detail) {
    CloudLayer layer = entry.layer;
    if (entry.shape) {
        layer.columns = layer.rows = entry.shape->resolution;
        layer.frames = entry.shape->frames;
        layer.thickness = detail == CloudDetail::fields
                              ? make_height_field(*entry.shape, {layer.size.x, layer.size.y})
                              : std::vector{find_highest(*entry.shape)};
        for (float& thickness : layer.thickness) {
            thickness = static_cast<float>(static_cast<double>(thickness) * entry.thickness);
        }
    }
    return layer;
}

}  // namespace

Result<std::vector<Diagnostic>> load_clouds(const MediaFile& media, Scene& scene,
                                            CloudDetail detail) {
    if (scene.layers.size() + media.clouds.size() > kMaxLayers) {
        return make_error(ErrorKind::bad_input, media.file, "clouds",
                          "the scene has more than one cloud layer in all, and this version "
                          "simulates one",
                          "keep one of them");
    }
    std::vector<Diagnostic> warnings;
    for (const CloudEntry& entry : media.clouds) {
        CloudLayer layer = load_layer(entry, detail);
        if (*std::max_element(layer.thickness.begin(), layer.thickness.end()) <= 0) {
            warnings.push_back(make_warning(media.file, entry.where,
                                            "its thickness is 0 everywhere: nothing is seen of it",
                                            "leave the layer out, or make it thicker"));
        }
        scene.layers.push_back(std::move(layer));
    }
    return warnings;
}

}  // namespace opaline::formats
