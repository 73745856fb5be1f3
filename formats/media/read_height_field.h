#pragma once

#include "formats/gltf/resources.h"
#include "formats/media/fields.h"
#include "formats/scene.h"

namespace opaline::formats::media {

/// Thickness of a cloud layer from the pictures that `height_field` names, with `thickness`,
/// `frame_seconds` and `loop`. Errors go to the report: files that cannot be read, values that are
/// no thickness, frames of different sizes. Precondition: the key is there.
void read_height_field(const Fields& fields, gltf::Resources& resources, CloudLayer& layer);

}  // namespace opaline::formats::media
