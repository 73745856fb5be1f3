#pragma once

#include "tests/formats/opal/volume_fixture.h"

namespace opaline::tests {

/// Light of its own for the volumes of make_volume_asset: the first one is the emitter 'Fire' in
/// one of its bricks and scatters its light in four terms, the second scatters it in one.
inline void add_glow(formats::Asset& asset) {
    using namespace formats;
    append_emitter(asset.emitters, "Fire");
    Glow& glow = asset.volumes.glow;
    std::mt19937 generator(3);
    std::uniform_int_distribution<std::uint32_t> code(0, 0xf7ffffffu);
    std::uniform_int_distribution<std::uint32_t> half(0, 0x7bff);
    const auto add_values = [&](std::uint32_t volume, std::uint32_t terms) {
        const std::size_t count = std::size_t{3} * asset.volumes.records[volume].node_count * terms;
        for (std::size_t i = 0; i < count; ++i) {
            glow.value.push_back(static_cast<std::uint16_t>(half(generator)));
        }
    };
    glow.record.push_back({0, 0, 0, 0.25f, 4, 0, 1, 2, {}});
    glow.brick.push_back(1);
    for (std::size_t i = 0; i < kBrickVoxels; ++i) {
        glow.code.push_back(code(generator));
    }
    add_values(0, 4);
    glow.record.push_back({1, 0, glow.value.size(), 0.5f, 1, 1, 0, 0, {}});
    add_values(1, 1);
}

/// make_volume_asset with light of its own.
inline formats::Asset make_glow_asset() {
    formats::Asset asset = make_volume_asset();
    add_glow(asset);
    return asset;
}

}  // namespace opaline::tests
