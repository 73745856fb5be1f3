#include "bake/reference/glossy_brdf.h"
#include "bake/reference/lamp_sampler.h"
#include "bake/reference/path_filter.h"
#include "bake/scene/base_color.h"

namespace opaline::bake {
namespace {

using formats::Material;

glm::vec3 to_vec(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

SurfacePlace place_of(const formats::Scene& scene, const SurfaceHit& hit) {
    return surface_place(scene, hit.primitive, 3 * hit.triangle, {1 - hit.u - hit.v, hit.u, hit.v});
}

SurfacePlace place_of(std::uint32_t primitive, std::uint32_t vertex) {
    return {primitive, {vertex, vertex, vertex}, {1, 0, 0}};
}

OpaqueSurface opaque_surface(const formats::Scene& scene, const SurfacePlace& place,
                             const TextureView* view) {
    const formats::Primitive& p = scene.primitives[place.primitive];
    const Material& material = scene.materials[p.material];
    const formats::Gloss& gloss = material.gloss;
    OpaqueSurface surface;
    surface.base_color = base_color(scene, place, view);
    if (material.sheet) {
        surface.reflect = to_vec(material.sheet->reflect);
        surface.transmit = to_vec(material.sheet->transmit);
    }
    if (gloss.is_diffuse()) return surface;
    surface.metallic = gloss.metallic;
    surface.roughness = gloss.roughness;
    const glm::vec3 factor = roughness_texture(scene, place, view);
    surface.roughness *= factor.g;
    surface.metallic *= factor.b;
    const float root = (gloss.ior - 1) / (gloss.ior + 1);  // ior 0: all is reflected
    surface.f0 =
        glm::min(root * root * to_vec(gloss.specular_color), glm::vec3(1)) * gloss.specular;
    surface.f90 = gloss.specular;
    return surface;
}

}  // namespace

glm::vec3 base_color_at(const formats::Scene& scene, const SurfaceHit& hit,
                        const TextureView* view) {
    return base_color(scene, place_of(scene, hit), view);
}

glm::vec3 base_color_at_vertex(const formats::Scene& scene, std::uint32_t primitive,
                               std::uint32_t vertex) {
    return base_color(scene, place_of(primitive, vertex), nullptr);
}

OpaqueSurface opaque_surface_at(const formats::Scene& scene, const SurfaceHit& hit,
                                const TextureView* view) {
    return opaque_surface(scene, place_of(scene, hit), view);
}

OpaqueSurface opaque_surface_at_vertex(const formats::Scene& scene, std::uint32_t primitive,
                                       std::uint32_t vertex) {
    return opaque_surface(scene, place_of(primitive, vertex), nullptr);
}

glm::vec3 emission_of(const formats::Scene& scene, const SurfaceHit& hit, const TextureView* view) {
    const SurfacePlace place = place_of(scene, hit);
    return to_vec(emission_at(scene, hit.primitive, place.corner, place.weight, view));
}

}  // namespace opaline::bake
