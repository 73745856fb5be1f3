#pragma once

#include <cmath>

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

}  // namespace opaline::tests
