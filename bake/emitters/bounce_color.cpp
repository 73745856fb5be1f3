#include "bake/emitters/bounce_color.h"

#include "bake/scene/base_color.h"

namespace opaline::bake {
namespace {

glm::vec3 color_of(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

glm::vec3 diffuse_color(const formats::Scene& scene, const formats::Material& material,
                        const SurfacePlace& place, const TextureView* view) {
    const float metallic = material.gloss.metallic * roughness_texture(scene, place, view).b;
    return glm::clamp((1 - metallic) * base_color(scene, place, view), glm::vec3(0), glm::vec3(1));
}

}  // namespace

BounceColor bounce_color(const formats::Scene& scene, const TriangleSide& side,
                         const glm::vec3& weights, const TextureView* view) {
    const formats::Primitive& primitive = scene.primitives[side.primitive];
    const formats::Material& material = scene.materials[primitive.material];
    if (material.medium || (side.is_back && !material.double_sided && !material.sheet)) return {};
    const SurfacePlace place = surface_place(scene, side.primitive, side.first_index, weights);
    const glm::dvec3 color(diffuse_color(scene, material, place, view));
    if (!material.sheet) return {color, glm::dvec3(0)};
    return {color * glm::dvec3(color_of(material.sheet->reflect)),
            color * glm::dvec3(color_of(material.sheet->transmit))};
}

glm::vec3 base_image_color(const formats::Scene& scene, const TriangleSide& side,
                           const glm::vec3& weights, const TextureView* view) {
    return base_color_texture(
        scene, surface_place(scene, side.primitive, side.first_index, weights), view);
}

}  // namespace opaline::bake
