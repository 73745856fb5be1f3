#include "runtime/volumes/volume_glow.h"

#include <algorithm>

#include "formats/opal/shared_exponent.h"

namespace opaline::runtime {

using formats::kBrickSide;
using formats::kBrickVoxels;
using formats::kNoBrick;
using formats::Rgb;

VolumeGlow make_glow(const formats::VolumesView& volumes, std::size_t volume) {
    VolumeGlow glow;
    const formats::GlowRecord* const record = volumes.glow.own_of(volume);
    if (record == nullptr) return glow;
    glow.place.assign(volumes.records[volume].brick_count, kNoBrick);
    for (std::uint32_t i = 0; i < record->brick_count; ++i) {
        glow.place[volumes.glow.brick[record->first_brick + i]] = i;
    }
    glow.code = volumes.glow.code.subspan(record->first_brick * kBrickVoxels,
                                          record->brick_count * kBrickVoxels);
    glow.scale = record->code_scale;
    return glow;
}

Rgb glow_at(const VolumeGlow& glow, const BrickBlock& block, std::array<float, 3> at) {
    const auto place_of = [&](std::uint32_t brick) {
        return brick == kNoBrick ? kNoBrick : glow.place[brick];
    };
    if (std::ranges::all_of(block.number, [&](auto n) { return place_of(n) == kNoBrick; })) {
        return {};
    }
    std::array<std::size_t, 3> base{};
    std::array<float, 3> upper{};
    for (std::size_t a = 0; a < 3; ++a) {
        base[a] = std::min<std::size_t>(static_cast<std::size_t>(at[a]), kBrickSide - 1);
        upper[a] = at[a] - static_cast<float>(base[a]);
    }
    Rgb sum;
    for (std::size_t i = 0; i < 8; ++i) {
        std::size_t neighbour = 0, offset = 0;
        float weight = glow.scale;
        for (std::size_t a = 3; a-- > 0;) {
            const std::size_t position = base[a] + (i >> a & 1);
            neighbour |= (position / kBrickSide) << a;
            offset = offset * kBrickSide + position % kBrickSide;
            weight *= (i >> a & 1) != 0 ? upper[a] : 1 - upper[a];
        }
        const std::uint32_t place = place_of(block.number[neighbour]);
        if (place == kNoBrick) continue;
        sum = sum + weight * formats::unpack_shared(glow.code[place * kBrickVoxels + offset]);
    }
    return sum;
}

}  // namespace opaline::runtime
