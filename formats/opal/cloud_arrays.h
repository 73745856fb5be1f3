#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "formats/opal/clouds.h"
#include "formats/opal/layout.h"
#include "formats/opal/section_cursor.h"

namespace opaline::formats {

/// Cloud layers as they stand in `CLOU`: a head and the arrays of CloudsView in its order.

CloudsHead clouds_head(const CloudsView& clouds);

/// Head and arrays in the order of the file. They point into `head` and into what `clouds` points
/// to.
std::array<std::span<const std::byte>, 5> cloud_arrays(const CloudsHead& head,
                                                       const CloudsView& clouds);

/// Reads all of `clouds`. False where it does not fit into what is left of the section. What the
/// arrays say is not looked at: check_clouds.h.
bool take_clouds(SectionCursor& cursor, CloudsView& clouds);

}  // namespace opaline::formats
