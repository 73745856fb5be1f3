#include "bake/cli/error_map.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "formats/opal/receiver_errors.h"

namespace opaline::cli {
namespace {

constexpr float kBackground = 0.05f;  // radiance: a display value of 0.25

// Of a display value in [0, 1].
float linear_value(float code) {
    return code <= 0.04045f ? code / 12.92f : std::pow((code + 0.055f) / 1.055f, 2.4f);
}

formats::Rgb heat_color(float share) {
    const auto band = [share](float begin) {
        return linear_value(std::clamp(3 * share - begin, 0.0f, 1.0f));
    };
    return {band(0), band(1), band(2)};
}

// A row whose product with even light of radiance kBackground is 1: the same value a in each of
// the six face averages. The light's are kBackground (4 pi / 6) / n.
formats::SparseRow even_row(std::uint32_t n) {
    const auto side = static_cast<float>(n);
    formats::SparseRow row;
    row.average.assign(formats::kCubeFaces, side / (4 * std::numbers::pi_v<float> * kBackground));
    return row;
}

}  // namespace

formats::AssetView ErrorMap::view_of(const formats::AssetView& asset) const {
    formats::AssetView view;
    view.cubemap_size = asset.cubemap_size;
    view.primitives = primitives;
    view.transport = rows.view();
    view.position = asset.position;
    view.normal = asset.normal;
    view.base_color = color;
    view.texcoord = asset.texcoord;
    view.index = asset.index;
    view.images = asset.images;
    view.holes = asset.holes;
    return view;
}

ErrorMap make_error_map(const formats::AssetView& asset, std::span<const float> values,
                        float white) {
    ErrorMap map;
    map.rows = formats::make_sparse_rows(asset.cubemap_size, 8);
    const formats::SparseRow row = even_row(asset.cubemap_size);
    map.color.reserve(values.size());
    for (const float value : values) {
        formats::append_row(map.rows, row);
        map.color.push_back(heat_color(value / white));
    }
    for (formats::PrimitiveRecord primitive : asset.primitives) {
        primitive.terms = primitive.bands = 1;
        primitive.first_row = primitive.first_band_row = primitive.first_vertex;
        primitive.first_code = 0;
        primitive.shading = formats::Shading::diffuse;
        primitive.base_color_image = formats::kNoImage;
        primitive.flags &= formats::PrimitiveRecord::kDoubleSided;
        primitive.eta = 0;
        map.primitives.push_back(primitive);
    }
    return map;
}

OpenedLight error_map_light() {
    OpenedLight light;
    light.environment.layout = formats::Environment::Layout::lat_long;
    light.environment.width = 2;
    light.environment.height = 1;
    light.environment.pixel.assign(2, {kBackground, kBackground, kBackground});
    return light;
}

formats::Result<std::vector<float>> stored_errors(const OpenedAsset& asset,
                                                  const std::string& path) {
    auto errors = formats::read_receiver_errors(asset.file.bytes(), asset.loaded, path);
    if (errors && errors->empty()) {
        return formats::make_error(formats::ErrorKind::bad_input, path, "",
                                   "it does not hold errors by receiver",
                                   "bake it with --receiver-errors");
    }
    return errors;
}

}  // namespace opaline::cli
