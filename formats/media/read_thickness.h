#pragma once

#include <string>

#include "formats/gltf/resources.h"
#include "formats/media/fields.h"
#include "formats/media/media_file.h"

namespace opaline::formats::media {

/// How thick a cloud layer is, from `height_field`, `procedural` and `thickness` of its entry: a
/// decoded image, a formula, or even. Errors go to the report. Precondition: the layer's size is
/// known.
void read_thickness(const Fields& fields, gltf::Resources& resources, CloudEntry& cloud);

/// The file's name, the formula's, or "even", for messages. Precondition: read_thickness found no
/// fault.
std::string describe_thickness(const Fields& fields);

}  // namespace opaline::formats::media
