#include "bake/emitters/bounce_color.h"

#include "bake/scene/base_color.h"

namespace opaline::bake {
namespace {

glm::vec3 color_of(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

glm::vec3 clamped_color(const formats::Scene& scene, const SurfacePlace& place,
                        const TextureView* view) {
    return glm::clamp(base_color(scene, place, view), glm::vec3(0), glm::vec3(1));
}

}  // namespace

BounceColor bounce_color(const formats::Scene& scene, const TriangleSide& side,
                         const glm::vec3& weights, const TextureView* view) {
    const formats::Primitive& primitive = scene.primitives[side.primitive];
    const formats::Material& material = scene.materials[primitive.material];
    if (material.medium || (side.is_back && !material.double_sided && !material.sheet)) return {};
    const SurfacePlace place = surface_place(scene, side.primitive, side.first_index, weights);
    const float metallic = material.gloss.metallic * roughness_texture(scene, place, view).b;
    const glm::dvec3 color((1 - metallic) * clamped_color(scene, place, view));
    if (!material.sheet) return {color, glm::dvec3(0)};
    return {color * glm::dvec3(color_of(material.sheet->reflect)),
            color * glm::dvec3(color_of(material.sheet->transmit))};
}

MetalPart metal_part(const formats::Scene& scene, const TriangleSide& side,
                     const glm::vec3& weights) {
    const formats::Primitive& primitive = scene.primitives[side.primitive];
    const formats::Material& material = scene.materials[primitive.material];
    const formats::Gloss& gloss = material.gloss;
    if (material.medium || material.sheet || gloss.metallic == 0 ||
        (side.is_back && !material.double_sided)) {
        return {};
    }
    const SurfacePlace place = surface_place(scene, side.primitive, side.first_index, weights);
    const glm::vec3 texture = roughness_texture(scene, place);
    const double roughness{gloss.roughness * texture.g};
    return {glm::dvec3(clamped_color(scene, place, nullptr)), double{gloss.metallic * texture.b},
            roughness * roughness};
}

glm::vec3 base_image_color(const formats::Scene& scene, const TriangleSide& side,
                           const glm::vec3& weights, const TextureView* view) {
    return base_color_texture(
        scene, surface_place(scene, side.primitive, side.first_index, weights), view);
}

}  // namespace opaline::bake
