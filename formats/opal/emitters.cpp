#include "formats/opal/emitters.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/half.h"

namespace opaline::formats {

std::span<const EmitterBlock> EmittersView::blocks_of(std::uint32_t primitive) const {
    const auto first = std::ranges::lower_bound(block, primitive, {}, &EmitterBlock::primitive);
    const auto last = std::ranges::upper_bound(block, primitive, {}, &EmitterBlock::primitive);
    return {first, last};
}

const OwnLight* EmittersView::own_of(std::uint32_t primitive) const {
    const auto found = std::ranges::lower_bound(own, primitive, {}, &OwnLight::primitive);
    return found != own.end() && found->primitive == primitive ? &*found : nullptr;
}

std::uint32_t find_emitter(const EmittersView& emitters, std::string_view name) {
    std::uint32_t i = 0;
    while (i < emitters.size() && emitters.name(i) != name)
        ++i;
    return i;
}

std::string list_emitters(const EmittersView& emitters) {
    std::string list;
    for (std::uint32_t i = 0; i < emitters.size(); ++i) {
        list += i == 0 ? "'" : ", '";
        list += emitters.name(i);
        list += '\'';
    }
    return list;
}

void append_emitter(Emitters& emitters, std::string_view name) {
    emitters.text.insert(emitters.text.end(), name.begin(), name.end());
    emitters.name_end.push_back(static_cast<std::uint32_t>(emitters.text.size()));
}

void append_block(Emitters& emitters, std::uint32_t emitter, std::uint32_t primitive,
                  std::span<const Rgb> rows) {
    float largest = 0;
    for (const Rgb& row : rows) {
        largest = std::max({largest, std::abs(row.r), std::abs(row.g), std::abs(row.b)});
    }
    // A power of two: the scale itself rounds nothing. 2^14 leaves room above the largest value.
    const float scale =
        largest > 0 ? std::ldexp(1.0f, std::max(std::ilogb(largest) - 14, -126)) : 0;
    if (scale == 0) return;
    emitters.block.push_back({emitter, primitive, emitters.value.size(), scale, 0});
    emitters.value.reserve(emitters.value.size() + 3 * rows.size());
    for (const Rgb& row : rows) {
        for (const float value : {row.r, row.g, row.b}) {
            emitters.value.push_back(half_from_float(value / scale));
        }
    }
}

Rgb block_value(const EmittersView& emitters, const EmitterBlock& block, std::size_t row) {
    const auto value = emitters.value.subspan(block.first_value + 3 * row, 3);
    return block.scale *
           Rgb{float_from_half(value[0]), float_from_half(value[1]), float_from_half(value[2])};
}

}  // namespace opaline::formats
