#pragma once

#include <cmath>

#include "formats/opal/sheet_shares.h"
#include "tests/formats/opal/asset_fixture.h"

namespace opaline::tests {

/// make_small_asset with a normal map on its second primitive, and tangents of every kind.
inline formats::Asset make_normal_map_asset() {
    formats::Asset asset = make_small_asset();
    asset.normal_maps.record = {
        {.primitive = 1, .image = 0, .wrap_v = formats::Wrap::clamp, .scale = 0.75f}};
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        const auto angle = static_cast<float>(v);
        asset.normal_maps.tangent.push_back(
            v == 0 ? formats::Tangent{}
                   : formats::encode_tangent({std::cos(angle), 0, std::sin(angle)},
                                             v % 2 == 0 ? 1.0f : -1.0f));
    }
    return asset;
}

/// The same with a thin-walled second primitive, that of the map: it has two rows a vertex.
inline formats::Asset make_mapped_sheet_asset() {
    formats::Asset asset = make_normal_map_asset();
    formats::PrimitiveRecord& primitive = asset.primitives[1];
    primitive.shading = formats::Shading::sheet;
    primitive.terms = 2;
    primitive.flags = formats::PrimitiveRecord::kDoubleSided;
    const formats::SparseRow dark{3, {}, {}, std::vector<float>(18)};
    for (int v = 0; v < 4; ++v) {
        formats::append_row(asset.transport, dark);
    }
    formats::store_sheet_shares({{0.5f, 0.25f, 0}, {0.25f, 0.75f, 1}}, asset.normal_maps.record[0]);
    return asset;
}

}  // namespace opaline::tests
