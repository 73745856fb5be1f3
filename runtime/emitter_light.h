#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/opal/asset.h"
#include "formats/opal/rgb.h"

namespace opaline::runtime {

/// How bright the emitters of an asset are: their light is added to that of the environment.
struct EmitterLight {
    /// Of each emitter, times what it was authored as, finite, >= 0; empty: 1 each.
    std::span<const formats::Rgb> color{};
    /// Whether emitting surfaces show the radiance that they send out by themselves.
    bool shows_own = true;

    formats::Rgb color_of(std::uint32_t emitter) const {
        return color.empty() ? formats::Rgb{1, 1, 1} : color[emitter];
    }
};

/// All are off.
EmitterLight dark_emitters();

/// Adds their light to products <T_k, L> of rows of a primitive: of `products.size()` rows from
/// `first_row` on, counted from the primitive's first one. Emitter by emitter, so that results do
/// not depend on how rows are cut into ranges.
void add_emitters(const formats::EmittersView& emitters, const EmitterLight& light,
                  std::uint32_t primitive, std::size_t first_row, std::span<formats::Rgb> products);

/// What the surface of a primitive sends out by itself, without its image.
formats::Rgb own_radiance(const formats::EmittersView& emitters, const EmitterLight& light,
                          std::uint32_t primitive);

}  // namespace opaline::runtime
