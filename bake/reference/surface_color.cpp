#include <array>

#include "bake/reference/lamp_sampler.h"
#include "bake/reference/opaque_surface.h"
#include "bake/reference/path_filter.h"
#include "bake/scene/emission.h"
#include "bake/scene/marble.h"
#include "bake/scene/sample_image.h"

namespace opaline::bake {
namespace {

using formats::Material;
using formats::Primitive;

glm::vec3 to_vec(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

/// A point of a primitive: weights over three vertices.
struct Place {
    std::uint32_t primitive;
    std::array<std::uint32_t, 3> corner;
    std::array<float, 3> weight;
};

Place place_of(const formats::Scene& scene, const SurfaceHit& hit) {
    const std::uint32_t* corner =
        &scene.primitives[hit.primitive].index[3 * std::size_t{hit.triangle}];
    return {hit.primitive, {corner[0], corner[1], corner[2]}, {1 - hit.u - hit.v, hit.u, hit.v}};
}

Place place_of(std::uint32_t primitive, std::uint32_t vertex) {
    return {primitive, {vertex, vertex, vertex}, {1, 0, 0}};
}

glm::vec2 texcoord_at(const Primitive& primitive, const Place& place) {
    glm::vec2 uv(0);
    for (std::size_t k = 0; k < 3; ++k) {
        uv += place.weight[k] * primitive.texcoord[place.corner[k]];
    }
    return uv;
}

// A texture at a place, over the footprint if there is one.
glm::vec3 look_up(const ImageLookup& lookup, std::uint32_t number, glm::vec2 uv,
                  const TextureView* view) {
    if (view == nullptr) {
        return sample_image(lookup, uv);
    }
    const ScenePyramids& all = view->pyramids;
    return sample_footprint(lookup, (lookup.is_linear ? all.data : all.color)[number], uv,
                            view->moments);
}

glm::vec3 base_color(const formats::Scene& scene, const Place& place, const TextureView* view) {
    const auto& [primitive, corner, weight] = place;
    const Primitive& p = scene.primitives[primitive];
    const Material& material = scene.materials[p.material];
    glm::vec3 color = to_vec(material.base_color);
    if (!p.color.empty()) {
        glm::vec3 own(0);
        for (std::size_t k = 0; k < 3; ++k) {
            own += weight[k] * to_vec(p.color[corner[k]]);
        }
        color *= own;
    }
    if (material.base_color_image != formats::kNone && !p.texcoord.empty()) {
        const formats::Image8& image = scene.images[material.base_color_image];
        if (image.width > 0 && image.height > 0) {
            color *= look_up({image, material.wrap_u, material.wrap_v, false},
                             material.base_color_image, texcoord_at(p, place), view);
        }
    }
    if (material.marble) {
        glm::vec3 position(0);
        for (std::size_t k = 0; k < 3; ++k) {
            position += weight[k] * p.position[corner[k]];
        }
        color *= to_vec(marble_color(*material.marble, scene.to_world(position)));
    }
    return color;
}

OpaqueSurface opaque_surface(const formats::Scene& scene, const Place& place,
                             const TextureView* view) {
    const Primitive& p = scene.primitives[place.primitive];
    const Material& material = scene.materials[p.material];
    const formats::Gloss& gloss = material.gloss;
    OpaqueSurface surface;
    surface.base_color = base_color(scene, place, view);
    if (material.sheet) {
        surface.reflect = to_vec(material.sheet->reflect);
        surface.transmit = to_vec(material.sheet->transmit);
    }
    if (gloss.is_diffuse()) {
        return surface;
    }
    surface.metallic = gloss.metallic;
    surface.roughness = gloss.roughness;
    if (gloss.image != formats::kNone && !p.texcoord.empty()) {
        const formats::Image8& image = scene.images[gloss.image];
        if (image.width > 0 && image.height > 0) {
            const glm::vec3 factor = look_up({image, gloss.wrap_u, gloss.wrap_v, true}, gloss.image,
                                             texcoord_at(p, place), view);
            surface.roughness *= factor.g;
            surface.metallic *= factor.b;
        }
    }
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
    const Place place = place_of(scene, hit);
    const Primitive& p = scene.primitives[hit.primitive];
    const Material& material = scene.materials[p.material];
    if (view == nullptr || material.emission_image == formats::kNone || p.texcoord.empty() ||
        scene.images[material.emission_image].rgba.empty()) {
        return to_vec(emission_at(scene, hit.primitive, place.corner, place.weight));
    }
    const ImageLookup lookup{scene.images[material.emission_image], material.emission_wrap_u,
                             material.emission_wrap_v, false};
    return to_vec(material.emission) *
           look_up(lookup, material.emission_image, texcoord_at(p, place), view);
}

}  // namespace opaline::bake
