#pragma once

#include "formats/opal/gloss.h"
#include "formats/scene.h"

namespace opaline::bake {

/// How a texture coordinate outside [0, 1] is brought back inside, in the words of files.
formats::Wrap to_wrap(formats::TextureWrap wrap);

/// The gloss of an opaque material as files hold it; its image is that of the scene.
formats::GlossRecord make_lobe_record(const formats::Gloss& gloss);

}  // namespace opaline::bake
