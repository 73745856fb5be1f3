#pragma once

#include <span>
#include <vector>

#include "bake/pilot/pilot.h"

namespace opaline::bake {

/// All that a pilot may choose from, by the bytes that rows take; where the knobs fix the
/// coefficients, those in 8 and in 16 bits.
std::vector<Encoding> list_encodings(const Knobs& knobs);

/// The pairs of receivers in media under one encoding, those of the opaque ones put where they
/// belong: receiver by receiver again. Precondition: `opaque` has the encoding.
std::vector<CheckedPair> insert_opaque(const PilotScene& pilot,
                                       std::span<const PilotReceiver> receivers,
                                       std::span<const CheckedPair> in_media,
                                       const OpaquePairs& opaque, const Encoding& encoding,
                                       std::size_t lights);

}  // namespace opaline::bake
