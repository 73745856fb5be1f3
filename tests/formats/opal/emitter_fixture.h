#pragma once

#include <random>
#include <vector>

#include "tests/formats/opal/asset_fixture.h"

namespace opaline::tests {

/// Adds two emitters, 'Lamp' and 'Panel', to an asset of at least two primitives: the first lights
/// all, the second only the last one; the first primitive glows as 'Panel', with the image if there
/// is one.
inline void add_emitters(formats::Asset& asset) {
    using namespace formats;
    std::mt19937 generator(9);
    std::uniform_real_distribution<float> uniform(0, 40);
    append_emitter(asset.emitters, "Lamp");
    append_emitter(asset.emitters, "Panel");
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        for (std::uint32_t e = 0; e < (p + 1 == asset.primitives.size() ? 2u : 1u); ++e) {
            std::vector<Rgb> rows(asset.primitives[p].vertex_count * asset.primitives[p].terms);
            for (Rgb& row : rows) {
                row = {uniform(generator), 0.01f * uniform(generator), uniform(generator)};
            }
            append_block(asset.emitters, e, p, rows);
        }
    }
    asset.emitters.own.push_back(
        {0, 1, {100, 50, 25}, asset.images.empty() ? kNoImage : 0, Wrap::mirror, Wrap::clamp});
}

/// `make_small_asset` with emitters.
inline formats::Asset make_emitter_asset() {
    formats::Asset asset = make_small_asset();
    add_emitters(asset);
    return asset;
}

}  // namespace opaline::tests
