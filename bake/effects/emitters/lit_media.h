#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/rows/medium_rows.h"
#include "bake/exchange/lamp_bounces.h"
#include "bake/receivers/receiver.h"
#include "formats/opal/asset.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {

/// Media of a scene, as the emitters' stages see them.
struct LitMedia {
    const FinishedMedia* finished = nullptr;  ///< null: there are none
    std::span<const RowLayout> layouts;       ///< by material
};

/// Rows of lamps' light on media: [primitive][lamp][row], outgoing radiance [nit] as `T_k` holds
/// it; nothing of other primitives.
using LampRowsOfMedia = std::vector<std::vector<std::vector<formats::Rgb>>>;

/// What media make of the light of lamps that arrives at them, straight and from other surfaces, by
/// their own effects. `primitives`: of the file.
LampRowsOfMedia light_media(const LitMedia& media, const LampBounces& light,
                            std::span<const ReceiverSet> receivers,
                            std::span<const formats::PrimitiveRecord> primitives,
                            const Context& context, std::uint64_t& rays);

/// The smallest basis that has a column for each lamp: n of 6 n n, a power of two.
std::uint32_t lamp_basis(std::size_t lamps);

}  // namespace opaline::bake
