#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/half.h"
#include "formats/opal/preview_image.h"

namespace opaline::formats {

/// What an `.opal` file holds of surfaces that light passes in places; formats/README.md, `HOLE`.

/// What alpha means: glTF's alphaMode.
enum class HoleMode : std::uint32_t {
    mask = 1,   ///< the surface is there where alpha >= cutoff
    blend = 2,  ///< alpha is the share of it that is there
};

/// Alpha of the surface of a primitive that is not translucent: `alpha` times that of its vertices
/// times the first channel of its image, code / 255. Fixed size, stored as is.
struct HoleRecord {
    std::uint32_t primitive = 0;
    std::uint32_t image = kNoImage;  ///< index into images; its coordinates are the vertices'
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    float alpha = 1;     ///< in [0, 1]
    float cutoff = 0.5;  ///< of a mask: finite, >= 0
    HoleMode mode = HoleMode::mask;
    std::uint32_t clear = 0;  ///< of glass (ClearShare), else 0: earlier readers know no other
};
static_assert(sizeof(HoleRecord) == 32);

/// Thin glass: of the light that meets the surface, `share` times thin_glass_transmittance passes.
struct ClearShare {
    float share = 0;  ///< in [0, 1]
    float eta = 0;    ///< >= 1; or 0: infinite
};

/// Of `HOLE`, where a record has one.
inline constexpr std::uint32_t kClearHolesVersion = 2;

/// As halves. Precondition: eta is at most kLargestHalf.
inline void store_clear_share(const ClearShare& clear, HoleRecord& hole) {
    hole.clear = std::uint32_t{half_from_float(clear.share)} |
                 std::uint32_t{half_from_float(clear.eta)} << 16;
}

inline ClearShare clear_share_of(const HoleRecord& hole) {
    return {float_from_half(static_cast<std::uint16_t>(hole.clear)),
            float_from_half(static_cast<std::uint16_t>(hole.clear >> 16))};
}

/// All holes of an asset as spans, into the bytes of a file or into `Holes`. Immutable.
struct HolesView {
    std::span<const HoleRecord> record;   ///< ascending by primitive, one each at most
    std::span<const float> vertex_alpha;  ///< in [0, 1]: of all vertices, or empty: 1

    bool empty() const { return record.empty(); }
    /// Of a primitive; null: its surface is whole.
    const HoleRecord* of(std::uint32_t primitive) const;
};

/// Owning twin of `HolesView`: what the baker builds.
struct Holes {
    std::vector<HoleRecord> record;
    std::vector<float> vertex_alpha;

    HolesView view() const { return {record, vertex_alpha}; }
};

}  // namespace opaline::formats
