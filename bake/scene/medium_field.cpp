#include "bake/scene/medium_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/base/parallel_indices.h"
#include "bake/physics/scattering_color.h"
#include "bake/scene/marble.h"
#include "bake/scene/nearest_surface.h"
#include "bake/scene/texture_pyramid.h"

namespace opaline::bake {
namespace {

using formats::InnerTexture;
using formats::Rgb;
using formats::Variation;

constexpr float kLeastDensity = 1.0f / 255, kCodes = 65535;

glm::vec3 to_vec(Rgb c) {
    return {c.r, c.g, c.b};
}

/// Of the textures of a variation; empty ones are looked up at points.
struct VariationPyramids {
    TexturePyramid color, strength, density;
};

VariationPyramids make_variation_pyramids(const formats::Scene& scene, const Variation& variation) {
    const auto make = [&](const InnerTexture& texture, bool is_linear) {
        return texture.image == formats::kNone || is_even(scene.inner_images[texture.image])
                   ? TexturePyramid{}
                   : make_pyramid(scene.inner_images[texture.image], is_linear);
    };
    return {make(variation.color, false), make(variation.strength, true),
            make(variation.density, true)};
}

// Textures of a variation on the surface, over a square of `area` [m^2] around a point: colour
// times strength, and density.
glm::vec4 sample_textures(const formats::Scene& scene, const Variation& variation,
                          const VariationPyramids& pyramids, const NearestSurface::Place& place,
                          double area) {
    const formats::Primitive& p = scene.primitives[place.primitive];
    if (p.texcoord.empty()) return glm::vec4(1);
    const std::uint32_t* const corner = &p.index[place.first_index];
    const glm::vec2 uv = (1 - place.u - place.v) * p.texcoord[corner[0]] +
                         place.u * p.texcoord[corner[1]] + place.v * p.texcoord[corner[2]];
    const UvMoments over = moments_of_area(uv_gradient(p, place.first_index), area);
    const auto look = [&](const InnerTexture& texture, const TexturePyramid& pyramid,
                          bool is_linear) {
        if (texture.image == formats::kNone || scene.inner_images[texture.image].rgba.empty()) {
            return glm::vec4(1);
        }
        return sample_footprint(
            {scene.inner_images[texture.image], texture.wrap_u, texture.wrap_v, is_linear}, pyramid,
            uv, over);
    };
    const glm::vec3 color = glm::vec3(look(variation.color, pyramids.color, false)) *
                            look(variation.strength, pyramids.strength, true).a;
    return {color, std::max(kLeastDensity, look(variation.density, pyramids.density, true).r)};
}

bool is_grey(const formats::Image8& image) {
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
        if (image.rgba[i] != image.rgba[i + 1] || image.rgba[i] != image.rgba[i + 2]) return false;
    }
    return true;
}

}  // namespace

bool is_grey(const formats::Scene& scene, const Variation& variation) {
    const bool has_grey_veins =
        !variation.marble || std::ranges::all_of(variation.marble->colors,
                                                 [](Rgb c) { return c.r == c.g && c.g == c.b; });
    return has_grey_veins && (variation.color.image == formats::kNone ||
                              is_grey(scene.inner_images[variation.color.image]));
}

MediumField::MediumField(const formats::Scene& scene, std::uint32_t material)
    : origin_(scene.origin) {
    const formats::Medium& medium = *scene.materials[material].medium;
    const Variation& variation = *medium.variation;
    marble_ = variation.marble;
    g_ = variation.g;
    has_density_ = variation.density.image != formats::kNone;
    const glm::vec3 scattered = to_vec(medium.sigma_s), absorbed = to_vec(medium.sigma_a);
    for (int b = 0; b < 3; ++b) {
        // As walks and reference divide: a white field changes no bit.
        stated_albedo_[b] = scattered[b] > 0 ? scattered[b] / (scattered[b] + absorbed[b]) : 0;
        stated_color_[b] = static_cast<float>(
            scattering_color(static_cast<double>(stated_albedo_[b]), static_cast<double>(g_)));
    }
    if (has_density_ || variation.color.image != formats::kNone ||
        variation.strength.image != formats::kNone) {
        fill_grid(scene, material);
    }
}

void MediumField::fill_grid(const formats::Scene& scene, std::uint32_t material) {
    constexpr float kCells = 96;
    const NearestSurface surface(scene, material);
    if (surface.is_empty()) return;
    glm::vec3 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t i = 0; p.material == material && i < p.index.size(); ++i) {
            low = glm::min(low, p.position[p.index[i]]);
            high = glm::max(high, p.position[p.index[i]]);
        }
    }
    const glm::vec3 size = high - low;
    const float longest = std::max({size.x, size.y, size.z});
    if (!(longest > 0)) return;
    GridNodes nodes{low, longest / kCells, glm::uvec3(0)};
    low_ = low;
    per_cell_ = 1 / nodes.cell;
    nodes.count = glm::min(glm::uvec3(glm::ceil(size * per_cell_)) + 1u,
                           glm::uvec3(static_cast<std::uint32_t>(kCells) + 2));
    nodes_ = glm::ivec3(nodes.count);
    const std::vector<NearestSurface::Place> places = find_nearest(scene, surface, nodes);
    const Variation& variation = *scene.materials[material].medium->variation;
    const VariationPyramids pyramids = make_variation_pyramids(scene, variation);
    const double cell = static_cast<double>(nodes.cell);
    grid_.resize(places.size());
    for_each_index(places.size(), [&](std::size_t i) {
        const glm::vec4 values =
            places[i].primitive == formats::kNone
                ? glm::vec4(1)
                : sample_textures(scene, variation, pyramids, places[i], cell * cell);
        for (std::size_t c = 0; c < grid_[i].size(); ++c) {
            const float value = std::clamp(values[static_cast<int>(c)], 0.0f, 1.0f);
            grid_[i][c] = static_cast<std::uint16_t>(std::lround(kCodes * value));
        }
    });
}

glm::vec4 MediumField::grid(glm::vec3 position) const {
    if (grid_.empty()) return glm::vec4(1);
    const glm::vec3 most(nodes_ - 1);
    const glm::vec3 place = glm::clamp((position - low_) * per_cell_, glm::vec3(0), most);
    const glm::ivec3 cell = glm::min(glm::ivec3(place), glm::max(nodes_ - 2, glm::ivec3(0)));
    const glm::vec3 share = place - glm::vec3(cell);
    const glm::ivec3 step = glm::min(glm::ivec3(1), nodes_ - 1 - cell);
    const auto at = [&](int x, int y, int z) {
        const glm::ivec3 n = cell + glm::ivec3(x, y, z) * step;
        const glm::uvec3 at_node(n), count(nodes_);
        const Codes& codes =
            grid_[(std::size_t{at_node.z} * count.y + at_node.y) * count.x + at_node.x];
        return glm::vec4(codes[0], codes[1], codes[2], codes[3]);
    };
    // Exact between equal values, as glm::mix is not.
    const auto mix = [](glm::vec4 a, glm::vec4 b, float s) { return a + s * (b - a); };
    const auto along_x = [&](int y, int z) { return mix(at(0, y, z), at(1, y, z), share.x); };
    const auto along_y = [&](int z) { return mix(along_x(0, z), along_x(1, z), share.y); };
    return mix(along_y(0), along_y(1), share.z) / kCodes;
}

float MediumField::mean_density(glm::vec3 from, glm::vec3 to) const {
    if (!has_density_ || grid_.empty()) return 1;
    constexpr float kStepsPerCell = 2, kMostSteps = 512;
    const float steps = std::clamp(std::ceil(kStepsPerCell * per_cell_ * glm::distance(from, to)),
                                   1.0f, kMostSteps);
    double sum = 0;
    for (float i = 0.5f; i < steps; ++i) {
        sum += static_cast<double>(density(from + i / steps * (to - from)));
    }
    return static_cast<float>(sum / static_cast<double>(steps));
}

glm::vec3 MediumField::color(glm::vec3 position) const {
    const glm::vec3 textures = grid_.empty() ? glm::vec3(1) : glm::vec3(grid(position));
    return marble_ ? textures * to_vec(marble_color(*marble_, origin_ + glm::dvec3(position)))
                   : textures;
}

glm::vec3 MediumField::albedo(glm::vec3 position) const {
    const glm::vec3 share = color(position);
    glm::vec3 albedo = stated_albedo_;
    for (int b = 0; b < 3; ++b) {
        if (share[b] < 1 && albedo[b] > 0) {
            albedo[b] = static_cast<float>(albedo_of_color(
                static_cast<double>(stated_color_[b] * share[b]), static_cast<double>(g_)));
        }
    }
    return albedo;
}

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
