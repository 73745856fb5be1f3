#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "formats/opal/emitters.h"
#include "formats/opal/layout.h"
#include "formats/opal/section_cursor.h"

namespace opaline::formats {

/// Emitters as they stand in `EMIT`: a head and the arrays of EmittersView in its order.

EmittersHead emitters_head(const EmittersView& emitters);

/// Head and arrays in the order of the file. They point into `head` and into what `emitters` points
/// to.
std::array<std::span<const std::byte>, 6> emitter_arrays(const EmittersHead& head,
                                                         const EmittersView& emitters);

/// Reads all of `emitters`. False where it does not fit into what is left of the section. What the
/// arrays say is not looked at: check_emitters.h.
bool take_emitters(SectionCursor& cursor, EmittersView& emitters);

}  // namespace opaline::formats
