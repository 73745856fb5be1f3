#pragma once

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// A material and its extensions. Errors: members of a wrong type. Values out of their ranges are
/// kept (build_materials judges them), and links are not checked.
MaterialSource read_material(const NamedObject& material);

}  // namespace opaline::formats::gltf
