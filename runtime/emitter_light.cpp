#include "runtime/emitter_light.h"

#include <array>

#include "formats/opal/half.h"

namespace opaline::runtime {

using formats::Rgb;

EmitterLight dark_emitters() {
    static constexpr std::array<Rgb, formats::kMaxEmitters> kDark{};
    return {kDark, false};
}

void add_emitters(const formats::EmittersView& emitters, const EmitterLight& light,
                  std::uint32_t primitive, std::size_t first_row, std::span<Rgb> products) {
    for (const formats::EmitterBlock& block : emitters.blocks_of(primitive)) {
        const Rgb color = block.scale * light.color_of(block.emitter);
        if (color.r == 0 && color.g == 0 && color.b == 0) continue;
        const auto value =
            emitters.value.subspan(block.first_value + 3 * first_row, 3 * products.size());
        for (std::size_t i = 0; i < products.size(); ++i) {
            products[i] = products[i] + color * Rgb{formats::float_from_half(value[3 * i]),
                                                    formats::float_from_half(value[3 * i + 1]),
                                                    formats::float_from_half(value[3 * i + 2])};
        }
    }
}

Rgb own_radiance(const formats::EmittersView& emitters, const EmitterLight& light,
                 std::uint32_t primitive) {
    const formats::OwnLight* const own = light.shows_own ? emitters.own_of(primitive) : nullptr;
    return own == nullptr ? Rgb{} : light.color_of(own->emitter) * own->radiance;
}

}  // namespace opaline::runtime
