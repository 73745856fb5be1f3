#include "bake/plan/surface_albedo.h"

#include "bake/scene/lobe_record.h"

namespace opaline::bake {
using formats::Rgb;
namespace {

bool has_lobe(const RowLayout& layout) {
    return layout.mirrors && !layout.translucent;
}

Rgb color_at(const formats::Scene& scene, const RowLayout& layout, const SurfacePlace& place,
             const TextureView* view) {
    const glm::vec3 base = base_color(scene, place, view);
    return layout.tint * Rgb{base.r, base.g, base.b};
}

formats::GlossSurface lobe_at(const formats::Scene& scene, const SurfacePlace& place, Rgb color,
                              const TextureView* view) {
    const formats::Gloss& gloss = scene.materials[scene.primitives[place.primitive].material].gloss;
    const glm::vec3 image = roughness_texture(scene, place, view);
    return formats::make_gloss_surface(make_lobe_record(gloss), color, gloss.metallic * image.b,
                                       gloss.roughness * image.g);
}

}  // namespace

SurfaceAlbedo eval_surface_albedo(const formats::Scene& scene, const RowLayout& layout,
                                  const SurfacePoint& point, const TextureView* view) {
    const SurfacePlace place =
        surface_place(scene, point.primitive, point.first_index, point.barycentric);
    const Rgb color = color_at(scene, layout, place, view);
    if (!has_lobe(layout)) return {color};
    const formats::GlossSurface lobe = lobe_at(scene, place, color, view);
    const MeanReflectance mean = mean_reflectance(lobe);
    return {mean.diffuse * color, mean.mirrored, lobe.roughness < kBroadLobe};
}

std::optional<SurfaceLobe> eval_lobe(const formats::Scene& scene, const RowLayout& layout,
                                     const SurfacePlace& place) {
    if (!has_lobe(layout)) return std::nullopt;
    const Rgb color = color_at(scene, layout, place, nullptr);
    return SurfaceLobe{lobe_at(scene, place, color, nullptr), color};
}

std::optional<formats::GlossSurface> eval_narrow_lobe(const formats::Scene& scene,
                                                      const RowLayout& layout,
                                                      const SurfacePlace& place) {
    if (!has_lobe(layout)) return std::nullopt;
    const formats::Gloss& gloss = scene.materials[scene.primitives[place.primitive].material].gloss;
    // The colour is that of metals alone.
    const Rgb color = gloss.metallic > 0 ? color_at(scene, layout, place, nullptr) : Rgb{1, 1, 1};
    const formats::GlossSurface lobe = lobe_at(scene, place, color, nullptr);
    return lobe.roughness < kBroadLobe ? std::optional(lobe) : std::nullopt;
}

}  // namespace opaline::bake
