#include "bake/scene/base_color.h"

#include "bake/scene/marble.h"

namespace opaline::bake {
namespace {

using formats::Material;

struct TextureOf {
    std::uint32_t image;
    formats::TextureWrap wrap_u, wrap_v;
    bool is_linear;
};

glm::vec3 vec_of(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

template <class Values>
auto mix(const SurfacePlace& place, const Values& values) {
    return place.weight[0] * values(place.corner[0]) + place.weight[1] * values(place.corner[1]) +
           place.weight[2] * values(place.corner[2]);
}

glm::vec3 look_up(const formats::Scene& scene, const SurfacePlace& place, const TextureOf& texture,
                  const TextureView* view) {
    const formats::Primitive& p = scene.primitives[place.primitive];
    if (texture.image == formats::kNone || p.texcoord.empty()) return glm::vec3(1);
    const formats::Image8& image = scene.images[texture.image];
    if (image.width == 0 || image.height == 0) return glm::vec3(1);
    return sample_over({image, texture.wrap_u, texture.wrap_v, texture.is_linear}, texture.image,
                       mix(place, [&](std::uint32_t i) { return p.texcoord[i]; }), view);
}

const Material& material_of(const formats::Scene& scene, const SurfacePlace& place) {
    return scene.materials[scene.primitives[place.primitive].material];
}

}  // namespace

SurfacePlace surface_place(const formats::Scene& scene, std::uint32_t primitive,
                           std::uint32_t first_index, const glm::vec3& weight) {
    const std::uint32_t* const corner = &scene.primitives[primitive].index[first_index];
    return {primitive, {corner[0], corner[1], corner[2]}, {weight.x, weight.y, weight.z}};
}

glm::vec3 base_color(const formats::Scene& scene, const SurfacePlace& place,
                     const TextureView* view) {
    const formats::Primitive& p = scene.primitives[place.primitive];
    const Material& material = material_of(scene, place);
    glm::vec3 color = vec_of(material.base_color);
    if (!p.color.empty()) {
        color *= mix(place, [&](std::uint32_t i) { return vec_of(p.color[i]); });
    }
    color *= base_color_texture(scene, place, view);
    if (material.marble) {
        const glm::vec3 position = mix(place, [&](std::uint32_t i) { return p.position[i]; });
        color *= vec_of(marble_color(*material.marble, scene.to_world(position)));
    }
    return color;
}

glm::vec3 base_color_texture(const formats::Scene& scene, const SurfacePlace& place,
                             const TextureView* view) {
    const Material& m = material_of(scene, place);
    return look_up(scene, place, {m.base_color_image, m.wrap_u, m.wrap_v, false}, view);
}

glm::vec3 roughness_texture(const formats::Scene& scene, const SurfacePlace& place,
                            const TextureView* view) {
    const formats::Gloss& gloss = material_of(scene, place).gloss;
    return look_up(scene, place, {gloss.image, gloss.wrap_u, gloss.wrap_v, true}, view);
}

glm::vec3 normal_texture(const formats::Scene& scene, const SurfacePlace& place) {
    const Material& m = material_of(scene, place);
    return look_up(scene, place, {m.normal_image, m.normal_wrap_u, m.normal_wrap_v, true}, nullptr);
}

glm::vec3 emission_texture(const formats::Scene& scene, const SurfacePlace& place,
                           const TextureView* view) {
    const Material& m = material_of(scene, place);
    return look_up(scene, place, {m.emission_image, m.emission_wrap_u, m.emission_wrap_v, false},
                   view);
}

formats::Rgb emission_at(const formats::Scene& scene, std::uint32_t primitive,
                         const std::array<std::uint32_t, 3>& corner,
                         const std::array<float, 3>& weight, const TextureView* view) {
    const glm::vec3 factor = emission_texture(scene, {primitive, corner, weight}, view);
    return scene.materials[scene.primitives[primitive].material].emission *
           formats::Rgb{factor.r, factor.g, factor.b};
}

}  // namespace opaline::bake
