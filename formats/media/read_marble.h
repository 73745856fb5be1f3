#pragma once

#include <optional>

#include "formats/media/fields.h"
#include "formats/scene.h"

namespace opaline::formats::media {

/// The member `marble` of a material, an object with `scale` [m] and `colors`, both of which have
/// defaults: grey veins in white stone, 40 mm apart. Nothing if it is absent or faulty; then the
/// report has the fault.
std::optional<Marble> read_marble(const Fields& material);

}  // namespace opaline::formats::media
