#include "bake/scene/even_media.h"

#include <algorithm>

#include "bake/physics/scattering_color.h"
#include "bake/scene/medium_field.h"

namespace opaline::bake {

formats::Medium even_medium(const formats::Scene& scene, std::uint32_t material) {
    formats::Medium medium = *scene.materials[material].medium;
    if (!medium.variation) return medium;
    const MediumField field(scene, material);
    glm::dvec3 color(0);
    double density = 0, area = 0;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t i = 0; p.material == material && i + 2 < p.index.size(); i += 3) {
            const glm::vec3 a = p.position[p.index[i]], b = p.position[p.index[i + 1]],
                            c = p.position[p.index[i + 2]];
            const glm::dvec3 across = glm::cross(glm::dvec3(b - a), glm::dvec3(c - a));
            const double own = 0.5 * glm::length(across);
            const glm::vec3 middle = (a + b + c) / 3.0f;
            color += own * glm::dvec3(field.color(middle));
            density += own * static_cast<double>(field.density(middle));
            area += own;
        }
    }
    const auto g = static_cast<double>(medium.variation->g);
    medium.variation.reset();
    if (!(area > 0)) return medium;
    density /= area;
    const auto even_out = [&](float& sigma_s, float& sigma_a, double share) {
        const auto sigma_t = static_cast<double>(sigma_s) + static_cast<double>(sigma_a);
        if (!(sigma_s > 0)) {
            sigma_a = static_cast<float>(density * sigma_t);
            return;
        }
        const double stated = scattering_color(static_cast<double>(sigma_s) / sigma_t, g);
        const double albedo = albedo_of_color(std::clamp(stated * share / area, 0.0, 1.0), g);
        sigma_s = static_cast<float>(density * sigma_t * albedo);
        sigma_a = static_cast<float>(density * sigma_t * (1 - albedo));
    };
    even_out(medium.sigma_s.r, medium.sigma_a.r, color.x);
    even_out(medium.sigma_s.g, medium.sigma_a.g, color.y);
    even_out(medium.sigma_s.b, medium.sigma_a.b, color.z);
    return medium;
}

std::optional<EvenedScene> even_media(const formats::Scene& scene) {
    std::optional<EvenedScene> evened;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        if (!scene.materials[m].medium || !scene.materials[m].medium->variation) continue;
        if (!evened) {
            evened.emplace(EvenedScene{scene, {}});
        }
        evened->scene.materials[m].medium = even_medium(scene, m);
        evened->warnings.push_back(formats::make_warning(
            "", "material '" + scene.materials[m].name + "'",
            "its medium varies from point to point, and the model asked for knows homogeneous "
            "ones only: it takes the means over the surface of scattering colour and density",
            "leave --multiple-model out, or give --multiple-model walks"));
    }
    return evened;
}

}  // namespace opaline::bake
