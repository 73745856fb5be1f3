#include <array>
#include <cmath>

#include "bake/encode/marble.h"
#include "bake/reference/opaque_surface.h"
#include "formats/image/srgb.h"

namespace opaline::bake {
namespace {

using formats::Material;
using formats::Primitive;
using formats::TextureWrap;

const std::array<float, 256>& linear_codes() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] = formats::linear_from_srgb(static_cast<float>(i) / 255.0f);
        }
        return values;
    }();
    return table;
}

std::uint32_t wrap(std::int64_t i, std::int64_t size, TextureWrap mode) {
    if (mode == TextureWrap::clamp) {
        i = i < 0 ? 0 : i >= size ? size - 1 : i;
    } else if (mode == TextureWrap::repeat) {
        i = (i % size + size) % size;
    } else {
        const std::int64_t period = 2 * size;
        i = (i % period + period) % period;
        i = i < size ? i : period - 1 - i;
    }
    return static_cast<std::uint32_t>(i);
}

struct Texture {
    const formats::Image8& image;
    TextureWrap wrap_u, wrap_v;
    bool is_linear;  ///< codes are values times 255; else sRGB
};

glm::vec3 sample_texture(const Texture& texture, glm::vec2 uv) {
    const formats::Image8& image = texture.image;
    // Far outside [0, 1], floats do not resolve texels.
    constexpr float kLargest = 1e6f;
    if (!(std::abs(uv.x) < kLargest) || !(std::abs(uv.y) < kLargest)) {
        uv = glm::vec2(0);
    }
    const float x = uv.x * static_cast<float>(image.width) - 0.5f;
    const float y = uv.y * static_cast<float>(image.height) - 0.5f;
    const float x0 = std::floor(x), y0 = std::floor(y), s = x - x0, t = y - y0;
    const auto at = [&](int dx, int dy) {
        const std::uint32_t column =
            wrap(static_cast<std::int64_t>(x0) + dx, image.width, texture.wrap_u);
        const std::uint32_t row =
            wrap(static_cast<std::int64_t>(y0) + dy, image.height, texture.wrap_v);
        const std::uint8_t* code = &image.rgba[4 * (std::size_t{row} * image.width + column)];
        if (texture.is_linear) {
            return glm::vec3(code[0], code[1], code[2]) / 255.0f;
        }
        const auto& linear = linear_codes();
        return glm::vec3(linear[code[0]], linear[code[1]], linear[code[2]]);
    };
    return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}

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

glm::vec3 base_color(const formats::Scene& scene, const Place& place) {
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
            color *= sample_texture({image, material.wrap_u, material.wrap_v, false},
                                    texcoord_at(p, place));
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

OpaqueSurface opaque_surface(const formats::Scene& scene, const Place& place) {
    const Primitive& p = scene.primitives[place.primitive];
    const Material& material = scene.materials[p.material];
    const formats::Gloss& gloss = material.gloss;
    OpaqueSurface surface;
    surface.base_color = base_color(scene, place);
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
            const glm::vec3 factor =
                sample_texture({image, gloss.wrap_u, gloss.wrap_v, true}, texcoord_at(p, place));
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

glm::vec3 base_color_at(const formats::Scene& scene, const SurfaceHit& hit) {
    return base_color(scene, place_of(scene, hit));
}

glm::vec3 base_color_at_vertex(const formats::Scene& scene, std::uint32_t primitive,
                               std::uint32_t vertex) {
    return base_color(scene, place_of(primitive, vertex));
}

OpaqueSurface opaque_surface_at(const formats::Scene& scene, const SurfaceHit& hit) {
    return opaque_surface(scene, place_of(scene, hit));
}

OpaqueSurface opaque_surface_at_vertex(const formats::Scene& scene, std::uint32_t primitive,
                                       std::uint32_t vertex) {
    return opaque_surface(scene, place_of(primitive, vertex));
}

}  // namespace opaline::bake
