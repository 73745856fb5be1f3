#include "bake/scene/emission.h"

#include "bake/scene/base_color.h"

namespace opaline::bake {

formats::Rgb emission_at(const formats::Scene& scene, std::uint32_t primitive,
                         const std::array<std::uint32_t, 3>& corner,
                         const std::array<float, 3>& weight, const TextureView* view) {
    const glm::vec3 factor = emission_texture(scene, {primitive, corner, weight}, view);
    return scene.materials[scene.primitives[primitive].material].emission *
           formats::Rgb{factor.r, factor.g, factor.b};
}

}  // namespace opaline::bake
