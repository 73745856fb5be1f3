#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "formats/opal/layout.h"
#include "formats/opal/section_cursor.h"
#include "formats/opal/volumes.h"

namespace opaline::formats {

/// Volumes as they stand in `VOLU`: a head, the arrays of VolumesView in its order, their rows.

VolumesHead volumes_head(const VolumesView& volumes);

/// Heads, arrays and rows in the order of the file. They point into the heads (`rows` is that of
/// volumes.rows) and into what `volumes` points to.
std::vector<std::span<const std::byte>> volume_arrays(const VolumesHead& head,
                                                      const VolumesView& volumes,
                                                      const TransportHead& rows);

/// Reads all; sets all of `volumes` but the cubemap_size of its rows. False where it does not fit
/// into what is left of the section. What the arrays say is not looked at: check_volumes.h.
bool take_volumes(SectionCursor& cursor, VolumesView& volumes);

}  // namespace opaline::formats
