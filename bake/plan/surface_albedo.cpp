#include "bake/plan/surface_albedo.h"

#include "bake/scene/base_color.h"
#include "bake/scene/lobe_record.h"

namespace opaline::bake {
using formats::Rgb;

SurfaceAlbedo eval_surface_albedo(const formats::Scene& scene, const RowLayout& layout,
                                  const SurfacePoint& point, const TextureView* view) {
    const SurfacePlace place =
        surface_place(scene, point.primitive, point.first_index, point.barycentric);
    const glm::vec3 base = base_color(scene, place, view);
    const Rgb color = layout.tint * Rgb{base.r, base.g, base.b};
    if (layout.mirrors && !layout.translucent) {
        const formats::Material& material =
            scene.materials[scene.primitives[point.primitive].material];
        const glm::vec3 image = roughness_texture(scene, place, view);
        const MeanReflectance mean = mean_reflectance(formats::make_gloss_surface(
            make_lobe_record(material.gloss), color, material.gloss.metallic * image.b,
            material.gloss.roughness * image.g));
        return {mean.diffuse * color, mean.mirrored};
    }
    return {color};
}

}  // namespace opaline::bake
