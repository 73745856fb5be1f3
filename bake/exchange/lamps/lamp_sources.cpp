#include "bake/exchange/lamps/lamp_sources.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

#include "bake/exchange/lamps/point_box.h"
#include "bake/scene/base_color.h"
#include "bake/scene/punctual_light.h"
#include "bake/scene/texture_pyramid.h"

namespace opaline::bake {
namespace {

constexpr int kMostCuts = 4;            // halvings of a textured triangle's edges
constexpr double kMostParts = 65536;    // of a lamp, about
constexpr double kEvenRadiance = 0.01;  // of the brightest part: parts that differ less are one

using Weights = std::array<glm::dvec3, 3>;  // barycentric coordinates of three corners

struct TriangleSource {
    const formats::Scene& scene;
    std::uint32_t primitive;
    std::array<std::uint32_t, 3> vertex;
    const ScenePyramids* textures;
};

// Mean over the part with these corners.
glm::dvec3 emission_in(const TriangleSource& from, const Weights& corners) {
    const glm::vec3 middle((corners[0] + corners[1] + corners[2]) / 3.0);
    std::optional<TextureView> view;
    const auto& texcoord = from.scene.primitives[from.primitive].texcoord;
    if (from.textures != nullptr && !texcoord.empty()) {
        std::array<glm::dvec2, 3> uv{};
        for (std::size_t k = 0; k < 3; ++k) {
            for (int j = 0; j < 3; ++j) {
                uv[k] +=
                    corners[k][j] * glm::dvec2(texcoord[from.vertex[static_cast<std::size_t>(j)]]);
            }
        }
        view.emplace(TextureView{*from.textures, moments_of_triangle(uv)});
    }
    const formats::Rgb c = emission_at(from.scene, from.primitive, from.vertex,
                                       {middle.x, middle.y, middle.z}, view ? &*view : nullptr);
    return {c.r, c.g, c.b};
}

GlowingTriangle glowing_triangle(const TriangleSource& from, const Weights& weights) {
    const formats::Primitive& primitive = from.scene.primitives[from.primitive];
    std::array<glm::dvec3, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
        for (int j = 0; j < 3; ++j) {
            corner[k] += weights[k][j] *
                         glm::dvec3(primitive.position[from.vertex[static_cast<std::size_t>(j)]]);
        }
    }
    return make_glowing_triangle(corner, from.scene.materials[primitive.material].double_sided);
}

// Whether parts differ by so little that their mean stands for them.
bool are_even(std::span<const glm::dvec3> radiance) {
    glm::dvec3 low(radiance[0]), high(radiance[0]);
    for (const glm::dvec3& part : radiance) {
        low = glm::min(low, part);
        high = glm::max(high, part);
    }
    return glm::all(glm::lessThanEqual(high - low, kEvenRadiance * high));
}

// Appends a triangle and its parts. Returns its mean radiance; of a dark one nothing is appended.
glm::dvec3 add_part(const TriangleSource& from, const Weights& weights, int cuts,
                    std::vector<GlowingPart>& parts) {
    GlowingPart part{.whole = glowing_triangle(from, weights), .next = 0, .is_even = cuts == 0};
    if (!(part.whole.area > 0)) return glm::dvec3(0);
    const std::size_t place = parts.size();
    parts.push_back(part);
    glm::dvec3& mean = part.whole.radiance;
    if (cuts == 0) {
        mean = emission_in(from, weights);
    } else {
        const auto& [a, b, c] = weights;
        const glm::dvec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
        const std::array<Weights, 4> children{
            {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}}};
        std::array<glm::dvec3, 4> radiance;
        for (std::size_t k = 0; k < children.size(); ++k) {
            radiance[k] = add_part(from, children[k], cuts - 1, parts);
            mean += 0.25 * radiance[k];
        }
        // Children that are cut differ within.
        part.is_even = are_even(radiance) &&
                       std::all_of(parts.begin() + static_cast<std::ptrdiff_t>(place) + 1,
                                   parts.end(), [](const GlowingPart& p) { return p.is_even; });
        if (part.is_even) parts.resize(place + 1);
    }
    if (mean == glm::dvec3(0)) {
        parts.resize(place);
    } else {
        part.next = static_cast<std::uint32_t>(parts.size());
        parts[place] = part;
    }
    return mean;
}

// Halvings after which a part of the triangle has about a texel.
int cuts_of(const TriangleSource& from, int most) {
    const formats::Primitive& primitive = from.scene.primitives[from.primitive];
    const formats::Image8& image =
        from.scene.images[from.scene.materials[primitive.material].emission_image];
    const glm::dvec2 a(primitive.texcoord[from.vertex[0]]);
    const glm::dvec2 b = glm::dvec2(primitive.texcoord[from.vertex[1]]) - a,
                     c = glm::dvec2(primitive.texcoord[from.vertex[2]]) - a;
    // The longest edge, as texels: thin triangles cross many.
    const glm::dvec2 size(image.width, image.height);
    const double longest =
        std::max({glm::length(size * b), glm::length(size * c), glm::length(size * (c - b))});
    return longest > 1 ? static_cast<int>(std::min<double>(std::ceil(std::log2(longest)), most))
                       : 0;
}

GlowingVoxels collect_voxels(const formats::Volume& volume) {
    using Grid = formats::SparseGrid<glm::vec3>;
    const Grid& grid = volume.emission;
    GlowingVoxels voxels;
    voxels.to_scene = volume.density.to_scene;
    voxels.volume = std::abs(glm::determinant(glm::dmat3(voxels.to_scene)));
    std::size_t cell = 0;
    glm::ivec3 b;
    for (b.z = 0; b.z < grid.extent.z; ++b.z) {
        for (b.y = 0; b.y < grid.extent.y; ++b.y) {
            for (b.x = 0; b.x < grid.extent.x; ++b.x) {
                const std::uint32_t number = grid.table[cell++];
                for (int i = 0; number != Grid::kEmpty && i < static_cast<int>(Grid::kBrickVoxels);
                     ++i) {
                    const glm::vec3 q = grid.brick(number)[static_cast<std::size_t>(i)];
                    if (q == glm::vec3(0)) continue;
                    constexpr int kSide = Grid::kSide;
                    const glm::ivec3 in(i % kSide, i / kSide % kSide, i / (kSide * kSide));
                    voxels.centre.emplace_back(kSide * (grid.first_brick + b) + in);
                    voxels.radiance.emplace_back(q);
                }
            }
        }
    }
    return voxels;
}

}  // namespace

GlowingTriangle make_glowing_triangle(const std::array<glm::dvec3, 3>& corner, bool is_two_sided) {
    const glm::dvec3 cross = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    const double twice = glm::length(cross);
    return {corner, twice > 0 ? cross / twice : glm::dvec3(0), twice / 2, glm::dvec3(0),
            is_two_sided};
}

glm::dvec3 GlowingVoxels::power(std::size_t i) const {
    return 4 * std::numbers::pi * volume * radiance[i];
}

glm::dvec3 GlowingTriangle::power() const {
    return (is_two_sided ? 2 : 1) * std::numbers::pi * area * radiance;
}

LampSources make_lamp_sources(const formats::Scene& scene, const Lamp& lamp,
                              const ScenePyramids* textures) {
    LampSources sources;
    sources.primitives = lamp.primitives;
    const auto is_textured = [&](const formats::Primitive& primitive) {
        return scene.materials[primitive.material].emission_image != formats::kNone &&
               !primitive.texcoord.empty();
    };
    std::size_t textured = 0;
    for (const std::uint32_t p : lamp.primitives) {
        textured += is_textured(scene.primitives[p]) ? scene.primitives[p].index.size() / 3 : 0;
    }
    int most_cuts = kMostCuts;
    while (most_cuts > 0 && static_cast<double>(textured) * std::pow(4, most_cuts) > kMostParts) {
        --most_cuts;
    }
    for (const std::uint32_t p : lamp.primitives) {
        const formats::Primitive& primitive = scene.primitives[p];
        for (std::size_t i = 0; i + 2 < primitive.index.size(); i += 3) {
            const TriangleSource from{
                scene,
                p,
                {primitive.index[i], primitive.index[i + 1], primitive.index[i + 2]},
                textures};
            add_part(from, {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)},
                     is_textured(primitive) ? cuts_of(from, most_cuts) : 0, sources.parts);
        }
    }
    for (const GlowingPart& part : sources.parts) {
        if (part.is_even) sources.triangles.push_back(part.whole);
    }
    if (sources.triangles.size() == sources.parts.size()) sources.parts.clear();
    for (const std::uint32_t i : lamp.lights) {
        sources.lights.push_back(scene.lights[i]);
    }
    if (lamp.volume != formats::kNone) sources.voxels = collect_voxels(scene.volumes[lamp.volume]);
    const PointBox box = box_of_surfaces(scene);
    if (box.low.x <= box.high.x) {
        sources.centre = box.centre();
        sources.radius = box.radius();
    }
    return sources;
}

glm::dvec3 light_power(const LampSources& sources, const formats::Light& light) {
    const glm::dvec3 intensity(light.intensity.r, light.intensity.g, light.intensity.b);
    return light.type == formats::Light::Type::directional
               ? 4 * sources.radius * sources.radius * intensity
               : flux_per_intensity(light) * intensity;
}

}  // namespace opaline::bake
