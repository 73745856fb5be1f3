#pragma once

#include <optional>

#include "formats/media/fields.h"
#include "formats/scene.h"

namespace opaline::formats::media {

/// The member `thin_walled` of a material, an object with `reflect` and `transmit`, at least one of
/// them, whose sum is at most 1 in each channel. Nothing if it is absent or faulty; then the report
/// has the fault.
std::optional<Sheet> read_sheet(const Fields& material);

}  // namespace opaline::formats::media
