#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "formats/opal/glow.h"
#include "formats/opal/layout.h"
#include "formats/opal/section_cursor.h"

namespace opaline::formats {

/// Light of volumes as it stands in `GLOW`: a head and the arrays of GlowView in its order.

GlowHead glow_head(const GlowView& glow);

/// Head and arrays in the order of the file. They point into `head` and into what `glow` points to.
std::array<std::span<const std::byte>, 5> glow_arrays(const GlowHead& head, const GlowView& glow);

/// Reads all. False where it does not fit into what is left of the section. What the arrays say is
/// not looked at: check_glow.h.
bool take_glow(SectionCursor& cursor, GlowView& glow);

}  // namespace opaline::formats
