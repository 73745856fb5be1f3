#include "bake/scene/lobe_record.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {

formats::GlossRecord make_lobe_record(const formats::Gloss& gloss) {
    formats::GlossRecord record;
    record.metallic = gloss.metallic;
    record.roughness = gloss.roughness;
    const float root = (gloss.ior - 1) / (gloss.ior + 1);
    const float normal = root * root;  // ior 0 stands for an infinite one: 1
    const auto f0 = [&](float color) { return std::min(normal * color, 1.0f) * gloss.specular; };
    record.f0 = {f0(gloss.specular_color.r), f0(gloss.specular_color.g),
                 f0(gloss.specular_color.b)};
    record.f90 = gloss.specular;
    if (gloss.image != formats::kNone) {
        record.image = gloss.image;
        record.wrap_u = gloss.wrap_u;
        record.wrap_v = gloss.wrap_v;
    }
    return record;
}

MeanReflectance mean_reflectance(const formats::GlossSurface& surface) {
    // The midpoint rule in c^2.
    constexpr int kViews = 32;
    MeanReflectance mean{0, {0, 0, 0}};
    for (int i = 0; i < kViews; ++i) {
        const float cosine = std::sqrt((static_cast<float>(i) + 0.5f) / kViews);
        const formats::GlossAlbedo at = formats::eval_gloss_albedo(surface, cosine);
        mean.diffuse += at.diffuse / kViews;
        mean.mirrored = mean.mirrored + 1.0f / kViews * at.specular;
    }
    return mean;
}

}  // namespace opaline::bake
