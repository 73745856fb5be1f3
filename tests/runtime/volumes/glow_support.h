#pragma once

#include <functional>

#include "formats/opal/half.h"
#include "tests/runtime/volumes/synthetic_volume.h"

namespace opaline::test {

/// Makes the last volume, made of `volume`, glow as emitter 0: radiance per metre at index
/// coordinates, in the bricks that it has. Where `scattered` is not 0 its nodes scatter that much
/// alike in all directions: E_0.
inline void add_glow(formats::Volumes& volumes, const TestVolume& volume,
                     const std::function<formats::Rgb(float, float, float)>& emission,
                     formats::Rgb scattered) {
    const formats::VolumeRecord& v = volumes.records.back();
    formats::GlowRecord record;
    record.volume = static_cast<std::uint32_t>(volumes.records.size() - 1);
    record.first_brick = static_cast<std::uint32_t>(volumes.glow.brick.size());
    record.code_scale = 0x1p-6f;
    for (std::uint32_t cell = 0; cell < volume.extent[0] * volume.extent[1] * volume.extent[2];
         ++cell) {
        const std::uint32_t brick = volumes.table[v.first_cell + cell];
        if (brick == formats::kNoBrick) continue;
        volumes.glow.brick.push_back(brick);
        const std::array<std::uint32_t, 3> at{cell % volume.extent[0],
                                              cell / volume.extent[0] % volume.extent[1],
                                              cell / volume.extent[0] / volume.extent[1]};
        for (std::uint32_t i = 0; i < formats::kBrickVoxels; ++i) {
            const std::array<std::uint32_t, 3> in{i % 8, i / 8 % 8, i / 64};
            std::array<float, 3> p{};
            for (std::size_t a = 0; a < 3; ++a) {
                p[a] = static_cast<float>(8 * (volume.first_brick[a] + static_cast<int>(at[a])) +
                                          static_cast<int>(in[a]));
            }
            volumes.glow.code.push_back(formats::pack_shared(64.0f * emission(p[0], p[1], p[2])));
        }
    }
    record.brick_count = static_cast<std::uint32_t>(volumes.glow.brick.size()) - record.first_brick;
    record.first_value = volumes.glow.value.size();
    if (scattered != formats::Rgb{}) {
        record.terms = 1;
        record.value_scale = 1;
        for (std::uint32_t node = 0; node < v.node_count; ++node) {
            for (const float value : {scattered.r, scattered.g, scattered.b}) {
                volumes.glow.value.push_back(formats::half_from_float(value));
            }
        }
    }
    volumes.glow.record.push_back(record);
}

}  // namespace opaline::test
