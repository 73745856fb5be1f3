#include "bake/lamps/media_light.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <span>

#include "bake/lamps/onward_ray.h"
#include "bake/scene/texture_footprint.h"

namespace opaline::bake {
namespace {

// Of a lamp, by vertex; empty where the primitive sends out nothing.
std::span<const glm::vec3> exitance_of(const formats::Scene& scene, const MediaLight& media,
                                       std::size_t lamp, std::uint32_t primitive) {
    if (primitive >= media.exitance.size() || media.exitance[primitive].empty()) return {};
    const std::size_t vertices = scene.primitives[primitive].position.size();
    return std::span(media.exitance[primitive]).subspan(lamp * vertices, vertices);
}

glm::dvec3 mix_corners(const formats::Scene& scene, std::span<const glm::vec3> exitance,
                       const TriangleSide& side, const glm::vec3& weights,
                       const TextureView* view) {
    const std::uint32_t* const corner = &scene.primitives[side.primitive].index[side.first_index];
    const glm::vec3 mixed = weights.x * exitance[corner[0]] + weights.y * exitance[corner[1]] +
                            weights.z * exitance[corner[2]];
    return glm::dvec3(mixed * base_image_color(scene, side, weights, view));
}

std::array<glm::dvec2, 3> uv_of(const formats::Primitive& primitive, std::uint32_t first_index) {
    std::array<glm::dvec2, 3> uv;
    for (std::uint32_t c = 0; c < 3; ++c) {
        uv[c] = glm::dvec2(primitive.texcoord[primitive.index[first_index + c]]);
    }
    return uv;
}

}  // namespace

bool MediaLight::empty() const {
    return std::ranges::all_of(exitance, [](const auto& values) { return values.empty(); });
}

glm::dvec3 media_exitance(const formats::Scene& scene, const MediaLight& media, std::size_t lamp,
                          const TriangleSide& side, const glm::vec3& weights,
                          const TextureView* view) {
    const auto exitance = exitance_of(scene, media, lamp, side.primitive);
    if (exitance.empty() || side.is_back) return glm::dvec3(0);
    return mix_corners(scene, exitance, side, weights, view);
}

LampSources media_sources(const formats::Scene& scene, const MediaLight& media, std::size_t lamp,
                          const LampSources& lamp_sources, const ScenePyramids* textures) {
    LampSources sources;
    sources.centre = lamp_sources.centre;
    sources.radius = lamp_sources.radius;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const auto exitance = exitance_of(scene, media, lamp, p);
        if (exitance.empty()) continue;
        const formats::Primitive& primitive = scene.primitives[p];
        sources.triangles.reserve(sources.triangles.size() + primitive.index.size() / 3);
        for (std::uint32_t i = 0; i + 2 < primitive.index.size(); i += 3) {
            std::array<glm::dvec3, 3> corner;
            for (std::uint32_t c = 0; c < 3; ++c) {
                corner[c] = glm::dvec3(primitive.position[primitive.index[i + c]]);
            }
            GlowingTriangle triangle = make_glowing_triangle(corner, false);
            std::optional<TextureView> view;
            if (textures != nullptr && !primitive.texcoord.empty()) {
                view.emplace(TextureView{*textures, moments_of_triangle(uv_of(primitive, i))});
            }
            triangle.radiance =
                std::numbers::inv_pi * mix_corners(scene, exitance, {p, i, false},
                                                   glm::vec3(1.0f / 3), view ? &*view : nullptr);
            if (!(triangle.area > 0) || triangle.radiance == glm::dvec3(0)) continue;
            sources.triangles.push_back(triangle);
        }
    }
    return sources;
}

}  // namespace opaline::bake
