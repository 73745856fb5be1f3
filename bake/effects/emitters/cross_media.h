#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/rows/medium_rows.h"
#include "bake/exchange/lamp_bounces.h"
#include "bake/receivers/receiver.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {

/// Adds the light of lamps, and of surfaces that they light, that crosses a medium straight to the
/// rows of one of its primitives: [lamp][row], outgoing radiance [nit] as `T_k` holds it, or empty,
/// which is dark. It is no part of the exitance of media: particles and rays that look for light
/// cross media by themselves.
void add_crossing_light(const FinishedMedia& media, const ReceiverSet& set,
                        const LampBounces& light, std::vector<std::vector<formats::Rgb>>& rows,
                        const Context& context, std::uint64_t& rays);

}  // namespace opaline::bake
