#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/emitters/media_light.h"
#include "bake/emitters/medium_answer.h"
#include "bake/emitters/receiver_light.h"

namespace opaline::bake {

/// What media are lit from.
struct MediaJob {
    const LitMedia& media;
    std::span<const ReceiverSet> receivers;                ///< by primitive
    std::span<const formats::PrimitiveRecord> primitives;  ///< of the file
    std::uint32_t particles = 0;                           ///< of each lamp, at least 1
};

/// Rows of lamps' light on media: [primitive][lamp][row], outgoing radiance [nit] as `T_k` holds
/// it; nothing of other primitives.
using MediaRows = std::vector<std::vector<std::vector<formats::Rgb>>>;

/// Solves for the light of lamps that media scatter, with the exchange between media and other
/// surfaces. `light` comes without media; the light that media send to surfaces is added to its
/// irradiance, and `exitance` is the light that leaves them.
///
/// B = M (E_0 + K B) over media, M the response of the media, K transport from medium to medium,
/// straight or by other surfaces (particles). M is measured once at coarse settings, patch by
/// patch. Passes start at B = 0 and end when one changes B by less than a hundredth. The remaining
/// sum is extrapolated from the ratio of the last two, lamp by lamp and band by band. One more
/// application of M gives the rows.
MediaRows light_media(const MediaJob& job, const LampLight& light, std::span<ElementLight> elements,
                      MediaLight& exitance, const Context& context, std::uint64_t& rays);

/// The smallest basis that has a column for each lamp: n of 6 n n, a power of two.
std::uint32_t lamp_basis(std::size_t lamps);

/// The light of lamps as light that replaces the environment: column e is lamp e. `light` must
/// outlive it.
OtherLight make_lamp_columns(const LampLight& light);

}  // namespace opaline::bake
