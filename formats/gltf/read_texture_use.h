#pragma once

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"

namespace opaline::formats::gltf {

/// A textureInfo object; its links are not checked. Faults go to the report and give no texture.
void read_texture(const NamedObject& object, const char* key, TextureUse& use);

}  // namespace opaline::formats::gltf
