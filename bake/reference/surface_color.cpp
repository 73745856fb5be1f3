#include <array>
#include <cmath>

#include "bake/encode/marble.h"
#include "bake/reference/hit_scene.h"
#include "formats/image/srgb.h"

namespace opaline::bake {
namespace {

using formats::Material;
using formats::Primitive;

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

std::uint32_t wrap(std::int64_t i, std::int64_t size, Material::Wrap mode) {
    if (mode == Material::Wrap::clamp) {
        i = i < 0 ? 0 : i >= size ? size - 1 : i;
    } else if (mode == Material::Wrap::repeat) {
        i = (i % size + size) % size;
    } else {
        const std::int64_t period = 2 * size;
        i = (i % period + period) % period;
        i = i < size ? i : period - 1 - i;
    }
    return static_cast<std::uint32_t>(i);
}

glm::vec3 sample_texture(const formats::Image8& image, glm::vec2 uv, const Material& material) {
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
            wrap(static_cast<std::int64_t>(x0) + dx, image.width, material.wrap_u);
        const std::uint32_t row =
            wrap(static_cast<std::int64_t>(y0) + dy, image.height, material.wrap_v);
        const std::uint8_t* code = &image.rgba[4 * (std::size_t{row} * image.width + column)];
        const auto& linear = linear_codes();
        return glm::vec3(linear[code[0]], linear[code[1]], linear[code[2]]);
    };
    return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}

glm::vec3 to_vec(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

// Weighted over three corners.
glm::vec3 base_color(const formats::Scene& scene, std::uint32_t primitive,
                     const std::array<std::uint32_t, 3>& corner,
                     const std::array<float, 3>& weight) {
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
        glm::vec2 uv(0);
        for (std::size_t k = 0; k < 3; ++k) {
            uv += weight[k] * p.texcoord[corner[k]];
        }
        if (image.width > 0 && image.height > 0) {
            color *= sample_texture(image, uv, material);
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

}  // namespace

glm::vec3 base_color_at(const formats::Scene& scene, const SurfaceHit& hit) {
    const std::uint32_t* corner =
        &scene.primitives[hit.primitive].index[3 * std::size_t{hit.triangle}];
    return base_color(scene, hit.primitive, {corner[0], corner[1], corner[2]},
                      {1 - hit.u - hit.v, hit.u, hit.v});
}

glm::vec3 base_color_at_vertex(const formats::Scene& scene, std::uint32_t primitive,
                               std::uint32_t vertex) {
    return base_color(scene, primitive, {vertex, vertex, vertex}, {1, 0, 0});
}

}  // namespace opaline::bake
