#pragma once

#include "formats/opal/gloss_model.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The gloss of an opaque material as files hold it; its image is that of the scene.
formats::GlossRecord make_lobe_record(const formats::Gloss& gloss);

/// What a glossy surface makes of even light from everywhere: means over cosine-weighted views.
struct MeanReflectance {
    float diffuse = 1;               ///< multiplies base colour
    formats::Rgb mirrored{0, 0, 0};  ///< by its lobe
};
MeanReflectance mean_reflectance(const formats::GlossSurface& surface);

}  // namespace opaline::bake
