#pragma once

#include <optional>

#include "formats/media/fields.h"
#include "formats/scene.h"

namespace opaline::formats::media {

/// Veins, and whether they act inside the medium or on the light that leaves.
struct PlacedMarble {
    Marble marble;
    bool is_inside = false;
};

/// The member `marble` of a material, an object with `scale` [m], `colors` and `inside`, all of
/// which have defaults: grey veins in white stone, 40 mm apart, on the light that leaves. Nothing
/// if it is absent or faulty; then the report has the fault.
std::optional<PlacedMarble> read_marble(const Fields& material);

}  // namespace opaline::formats::media
