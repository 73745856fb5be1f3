#include "bake/scene/emission.h"

#include <glm/glm.hpp>

#include "bake/scene/sample_image.h"

namespace opaline::bake {

formats::Rgb emission_at(const formats::Scene& scene, std::uint32_t primitive,
                         const std::array<std::uint32_t, 3>& corner,
                         const std::array<float, 3>& weight) {
    const formats::Primitive& p = scene.primitives[primitive];
    const formats::Material& material = scene.materials[p.material];
    if (material.emission_image == formats::kNone || p.texcoord.empty()) {
        return material.emission;
    }
    const formats::Image8& image = scene.images[material.emission_image];
    if (image.width == 0 || image.height == 0) {
        return material.emission;
    }
    glm::vec2 uv(0);
    for (std::size_t k = 0; k < 3; ++k) {
        uv += weight[k] * p.texcoord[corner[k]];
    }
    const glm::vec4 factor =
        sample_image({image, material.emission_wrap_u, material.emission_wrap_v, false}, uv);
    return material.emission * formats::Rgb{factor.r, factor.g, factor.b};
}

}  // namespace opaline::bake
