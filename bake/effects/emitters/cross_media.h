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

/// Adds what leaves the medium around a lamp after it has scattered, as radiance that is the same
/// for all views but for what the boundary lets through: M / (pi (1 - F_ext)) for the exitance M.
/// `layout`: of the receivers' material; `rows` may be empty.
void add_leaving_light(const LampLight& lamps, const ReceiverSet& set, const RowLayout& layout,
                       std::vector<std::vector<formats::Rgb>>& rows, std::uint64_t& rays);

}  // namespace opaline::bake
