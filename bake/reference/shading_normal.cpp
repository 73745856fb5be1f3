#include "bake/reference/shading_normal.h"

#include "bake/scene/base_color.h"

namespace opaline::bake {
namespace {

using formats::Material;
using formats::Primitive;

// Red, green and blue codes as x, y and z, of which 128 is 0 (formats/README.md, `NORM`).
glm::vec3 coded_normal(const formats::Scene& scene, const SurfacePlace& place, float scale) {
    const glm::vec3 value = (255.0f * normal_texture(scene, place) - 128.0f) / 127.0f;
    return {scale * value.x, scale * value.y, value.z};
}

}  // namespace

glm::vec3 shading_normal(const formats::Scene& scene, const SurfaceHit& hit) {
    const Primitive& p = scene.primitives[hit.primitive];
    const Material& material = scene.materials[p.material];
    if (material.normal_image == formats::kNone || p.tangent.empty() || p.texcoord.empty()) {
        return hit.smooth;
    }
    const SurfacePlace place =
        surface_place(scene, hit.primitive, 3 * hit.triangle, {1 - hit.u - hit.v, hit.u, hit.v});
    glm::vec4 tangent(0.0f);
    for (int k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(k);
        tangent += place.weight[corner] * p.tangent[place.corner[corner]];
    }
    const glm::vec3 along(tangent);
    const glm::mat3 frame(along, tangent.w * glm::cross(hit.smooth, along), hit.smooth);
    const glm::vec3 mapped = frame * coded_normal(scene, place, material.normal_scale);
    const float size = glm::length(mapped);
    if (!(size > 0)) return hit.smooth;
    constexpr float kLeastCosine = 0.01f;
    const glm::vec3 normal = mapped / size;
    const float cosine = glm::dot(normal, hit.flat);
    return cosine >= kLeastCosine ? normal
                                  : glm::normalize(normal + (kLeastCosine - cosine) * hit.flat);
}

}  // namespace opaline::bake
