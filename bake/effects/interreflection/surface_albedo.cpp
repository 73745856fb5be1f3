#include "bake/effects/interreflection/surface_albedo.h"

#include <cmath>

#include "bake/scene/base_color.h"
#include "bake/scene/lobe_record.h"
#include "formats/opal/gloss_model.h"

namespace opaline::bake {
namespace {

using formats::Rgb;

// (1 - metallic) (1 - max E), the mean over diffuse views by the midpoint rule in c^2.
float diffuse_share_at(const formats::Material& material, Rgb color, glm::vec3 image) {
    constexpr int kViews = 8;
    const formats::GlossRecord record = make_lobe_record(material.gloss);
    const formats::GlossSurface surface = formats::make_gloss_surface(
        record, color, material.gloss.metallic * image.b, material.gloss.roughness * image.g);
    float sum = 0;
    for (int i = 0; i < kViews; ++i) {
        const float cosine = std::sqrt((static_cast<float>(i) + 0.5f) / kViews);
        sum += formats::eval_gloss_albedo(surface, cosine).diffuse;
    }
    return sum / kViews;
}

}  // namespace

Rgb eval_surface_albedo(const formats::Scene& scene, const RowLayout& layout,
                        const SurfacePoint& point, const TextureView* view) {
    const SurfacePlace place =
        surface_place(scene, point.primitive, point.first_index, point.barycentric);
    const glm::vec3 base = base_color(scene, place, view);
    const Rgb color = layout.tint * Rgb{base.r, base.g, base.b};
    if (layout.mirrors && !layout.translucent) {
        const formats::Material& material =
            scene.materials[scene.primitives[point.primitive].material];
        return diffuse_share_at(material, color, roughness_texture(scene, place, view)) * color;
    }
    return color;
}

}  // namespace opaline::bake
