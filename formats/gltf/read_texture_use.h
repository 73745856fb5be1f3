#pragma once

#include "formats/gltf/document.h"
#include "formats/gltf/named_object.h"

namespace opaline::formats::gltf {

/// A textureInfo object; its links are not checked. Faults go to the report and give no texture.
void read_texture(const NamedObject& object, const char* key, TextureUse& use);

}  // namespace opaline::formats::gltf
