#pragma once

#include "tests/formats/opal/asset_fixture.h"

namespace opaline::tests {

/// make_small_asset with a blend by the vertices' alpha, and a mask by the image's.
inline formats::Asset make_hole_asset() {
    using formats::HoleMode, formats::Wrap;
    formats::Asset asset = make_small_asset();
    asset.holes.record = {{.primitive = 0, .alpha = 0.25f, .mode = HoleMode::blend},
                          {.primitive = 1, .image = 0, .wrap_v = Wrap::mirror, .cutoff = 0.75f}};
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        asset.holes.vertex_alpha.push_back(v < 4 ? 0.25f * static_cast<float>(v) : 1.0f);
    }
    return asset;
}

}  // namespace opaline::tests
