#include "bake/scene/scene_facts.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "bake/scene/texture_pyramid.h"
#include "formats/image/srgb.h"

namespace opaline::bake {
namespace {

using formats::Rgb;

struct Range {
    Rgb low{1, 1, 1}, high{0, 0, 0};

    void add(Rgb c) {
        low = {std::min(low.r, c.r), std::min(low.g, c.g), std::min(low.b, c.b)};
        high = {std::max(high.r, c.r), std::max(high.g, c.g), std::max(high.b, c.b)};
    }
};

Range range_of_image(const formats::Image8& image, bool is_linear) {
    std::array<std::uint8_t, 3> low{255, 255, 255}, high{0, 0, 0};
    for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
        for (std::size_t band = 0; band < 3; ++band) {
            low[band] = std::min(low[band], image.rgba[i + band]);
            high[band] = std::max(high[band], image.rgba[i + band]);
        }
    }
    const auto decode = [&](const std::array<std::uint8_t, 3>& code) {
        const auto linear = [&](std::uint8_t c) {
            const float value = static_cast<float>(c) / 255;
            return is_linear ? value : formats::linear_from_srgb(value);
        };
        return Rgb{linear(code[0]), linear(code[1]), linear(code[2])};
    };
    return {decode(low), decode(high)};
}

// Along the direction in which texels are densest, over all triangles of the material.
double densest_texels(const formats::Scene& scene, std::uint32_t material,
                      const formats::Image8& image) {
    double most = 0;
    for (const formats::Primitive& p : scene.primitives) {
        if (p.material != material || p.texcoord.empty()) continue;
        for (std::uint32_t i = 0; i + 2 < p.index.size(); i += 3) {
            const UvMoments metre = moments_of_area(uv_gradient(p, i), 1);
            most = std::max(most, texture_taps(metre, {image.width, image.height}, 1).major);
        }
    }
    return most;
}

}  // namespace

ColorRange find_color_range(const formats::Scene& scene, std::uint32_t material) {
    Range vertex;
    for (const formats::Primitive& primitive : scene.primitives) {
        if (primitive.material != material) continue;
        if (primitive.color.empty()) {
            vertex.add({1, 1, 1});
        }
        for (const Rgb c : primitive.color) {
            vertex.add(c);
        }
    }
    const formats::Material& m = scene.materials[material];
    Rgb low = vertex.low, high = vertex.high;
    if (m.base_color_image != formats::kNone) {
        const Range image = range_of_image(scene.images[m.base_color_image], false);
        low = low * image.low;
        high = high * image.high;
    }
    if (m.marble) {
        Range veins;
        for (const Rgb c : m.marble->colors) {
            veins.add(c);
        }
        low = low * veins.low;
        high = high * veins.high;
    }
    return {std::max({vertex.high.r, vertex.high.g, vertex.high.b}),
            std::max({0.0f, high.r - low.r, high.g - low.g, high.b - low.b})};
}

TextureFacts find_texture_facts(const formats::Scene& scene, std::uint32_t material,
                                double brightest) {
    TextureFacts facts;
    const formats::Material& m = scene.materials[material];
    const auto add = [&](std::uint32_t number, bool is_linear) {
        Range range{{1, 1, 1}, {1, 1, 1}};
        if (number != formats::kNone && !scene.images[number].rgba.empty()) {
            const formats::Image8& image = scene.images[number];
            facts.texels_per_metre =
                std::max(facts.texels_per_metre, densest_texels(scene, material, image));
            range = range_of_image(image, is_linear);
        }
        return Rgb{range.high.r - range.low.r, range.high.g - range.low.g,
                   range.high.b - range.low.b};
    };
    const Rgb color = add(m.base_color_image, false), gloss = add(m.gloss.image, true);
    // A metal reflects nothing diffusely; the share that the lobe leaves changes no more than the
    // roughness does.
    const float lobe = m.gloss.roughness * gloss.g + m.gloss.metallic * gloss.b;
    facts.contrast =
        brightest *
        std::min(1.0, static_cast<double>(std::max({color.r, color.g, color.b}) + lobe));
    return facts;
}

}  // namespace opaline::bake
