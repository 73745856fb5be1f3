#include "bake/emitters/bounce_color.h"

#include "bake/scene/marble.h"
#include "bake/scene/sample_image.h"

namespace opaline::bake {
namespace {

glm::vec3 color_of(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

struct Corners {
    const formats::Scene& scene;
    const formats::Primitive& primitive;
    const std::uint32_t* index;
    const glm::vec3& weights;

    template <class Value>
    auto mix(Value&& value) const {
        return weights.x * value(index[0]) + weights.y * value(index[1]) +
               weights.z * value(index[2]);
    }
    // White where there is no image.
    glm::vec3 image(std::uint32_t number, formats::TextureWrap u, formats::TextureWrap v,
                    bool is_linear) const {
        if (number == formats::kNone || primitive.texcoord.empty()) return glm::vec3(1);
        const formats::Image8& pixels = scene.images[number];
        if (pixels.width == 0 || pixels.height == 0) return glm::vec3(1);
        return glm::vec3(sample_image({pixels, u, v, is_linear},
                                      mix([&](std::uint32_t i) { return primitive.texcoord[i]; })));
    }
};

glm::vec3 diffuse_color(const Corners& at, const formats::Material& material) {
    glm::vec3 color = color_of(material.base_color) *
                      at.image(material.base_color_image, material.wrap_u, material.wrap_v, false);
    if (!at.primitive.color.empty()) {
        color *= at.mix([&](std::uint32_t i) { return color_of(at.primitive.color[i]); });
    }
    if (material.marble) {
        const glm::vec3 position =
            at.mix([&](std::uint32_t i) { return at.primitive.position[i]; });
        color *= color_of(marble_color(*material.marble, at.scene.to_world(position)));
    }
    const formats::Gloss& gloss = material.gloss;
    const float metallic =
        gloss.metallic * at.image(gloss.image, gloss.wrap_u, gloss.wrap_v, true).b;
    return glm::clamp((1 - metallic) * color, glm::vec3(0), glm::vec3(1));
}

}  // namespace

BounceColor bounce_color(const formats::Scene& scene, const TriangleSide& side,
                         const glm::vec3& weights) {
    const formats::Primitive& primitive = scene.primitives[side.primitive];
    const formats::Material& material = scene.materials[primitive.material];
    if (material.medium || (side.is_back && !material.double_sided && !material.sheet)) return {};
    const Corners at{scene, primitive, &primitive.index[side.first_index], weights};
    const glm::dvec3 color(diffuse_color(at, material));
    if (!material.sheet) return {color, glm::dvec3(0)};
    return {color * glm::dvec3(color_of(material.sheet->reflect)),
            color * glm::dvec3(color_of(material.sheet->transmit))};
}

glm::vec3 base_image_color(const formats::Scene& scene, const TriangleSide& side,
                           const glm::vec3& weights) {
    const formats::Primitive& primitive = scene.primitives[side.primitive];
    const formats::Material& material = scene.materials[primitive.material];
    return Corners{scene, primitive, &primitive.index[side.first_index], weights}.image(
        material.base_color_image, material.wrap_u, material.wrap_v, false);
}

}  // namespace opaline::bake
