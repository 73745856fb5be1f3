#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/opal/preview_image.h"
#include "formats/opal/rgb.h"

namespace opaline::formats {

/// What an `.opal` file holds of light that does not come from the environment; formats/README.md,
/// `EMIT`.

inline constexpr std::uint32_t kMaxEmitters = 64;      ///< of a file
inline constexpr std::uint32_t kMaxEmitterName = 255;  ///< bytes

/// What one emitter, as authored, adds to the rows of one primitive: three halves a row, in the
/// order of the rows, times `scale`. Fixed size, stored as is.
struct EmitterBlock {
    std::uint32_t emitter = 0, primitive = 0;
    std::uint64_t first_value = 0;  ///< among EmittersView::value
    float scale = 0;                ///< >= 0, finite
    std::uint32_t reserved = 0;
};
static_assert(sizeof(EmitterBlock) == 24);

/// Radiance that the surface of a primitive sends out by itself: `radiance` times the image, if
/// any; part of the light of its emitter. Fixed size, stored as is.
struct OwnLight {
    std::uint32_t primitive = 0, emitter = 0;
    Rgb radiance;                    ///< [W m^-2 sr^-1], finite, >= 0
    std::uint32_t image = kNoImage;  ///< index into images, sRGB codes
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
};
static_assert(sizeof(OwnLight) == 32);

/// All emitters of an asset as spans, into the bytes of a file or into `Emitters`. Immutable.
struct EmittersView {
    std::span<const std::uint32_t> name_end;  ///< of each emitter, in `text`; ascending
    std::span<const char> text;               ///< names, UTF-8, one after the other
    std::span<const EmitterBlock> block;      ///< by primitive, then emitter; no pair twice
    std::span<const OwnLight> own;            ///< by primitive, one each at most
    std::span<const std::uint16_t> value;     ///< halves

    bool empty() const { return name_end.empty(); }
    std::uint32_t size() const { return static_cast<std::uint32_t>(name_end.size()); }
    /// Precondition: emitter < size().
    std::string_view name(std::uint32_t emitter) const {
        const std::size_t first = emitter == 0 ? 0 : name_end[emitter - 1];
        return std::string_view(text.data(), text.size()).substr(first, name_end[emitter] - first);
    }
    /// The blocks of a primitive, by emitter.
    std::span<const EmitterBlock> blocks_of(std::uint32_t primitive) const;
    /// Of a primitive; null: its surface sends out nothing.
    const OwnLight* own_of(std::uint32_t primitive) const;
};

/// The number of an emitter; view.size() where none has that name.
std::uint32_t find_emitter(const EmittersView& emitters, std::string_view name);

/// "'Lamp', 'Panel'": all names in order, for messages.
std::string list_emitters(const EmittersView& emitters);

/// Owning twin of `EmittersView`: what the baker builds.
struct Emitters {
    std::vector<std::uint32_t> name_end;
    std::vector<char> text;
    std::vector<EmitterBlock> block;
    std::vector<OwnLight> own;
    std::vector<std::uint16_t> value;

    EmittersView view() const { return {name_end, text, block, own, value}; }
};

/// Adds an emitter's name. Precondition: at most kMaxEmitterName bytes.
void append_emitter(Emitters& emitters, std::string_view name);

/// Adds a block of rows, as halves: each value errs by at most 2^-12 of itself, and those below
/// 1e-9 of the largest by that much of it. No block where all are 0. Call in the order of blocks.
/// Precondition: finite.
void append_block(Emitters& emitters, std::uint32_t emitter, std::uint32_t primitive,
                  std::span<const Rgb> rows);

/// Value of row `row` of a block, counted from the primitive's first row.
Rgb block_value(const EmittersView& emitters, const EmitterBlock& block, std::size_t row);

}  // namespace opaline::formats
