#pragma once

#include <cstdint>
#include <vector>

#include "bake/exchange/lamp_bounces.h"
#include "bake/receivers/receiver.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {

/// The rows of a set of opaque or thin-walled receivers: [lamp][row], outgoing radiance [nit]
/// without base colour, `terms` a receiver. Two terms: of the side of the normal, then of the other
/// one, as Shading::sheet has them.
std::vector<std::vector<formats::Rgb>> make_lamp_rows(const LampBounces& light,
                                                      const ReceiverSet& set, std::uint32_t terms,
                                                      const Context& context, std::uint64_t& rays);

}  // namespace opaline::bake
