#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "runtime/normal_maps/turned_light.h"
#include "runtime/surface.h"
#include "runtime/texture.h"
#include "tests/bench/gl_parity/comparisons.h"
#include "tests/runtime/embed_gl/host/host_images.h"

namespace opaline::parity {
namespace {

using formats::Rgb;
using formats::Vec3;
using test::HostRay;

constexpr int kSamples = 300;

// The largest of three bands, each as a share of 1 + `scale` times the CPU's; infinite where one
// is not a number, which a maximum may pass over.
double difference_of(const float* gl, Rgb cpu, float scale) {
    if (!std::isfinite(gl[0] + gl[1] + gl[2])) return std::numeric_limits<double>::infinity();
    return static_cast<double>(std::max({std::abs(gl[0] - cpu.r) / (1 + scale * cpu.r),
                                         std::abs(gl[1] - cpu.g) / (1 + scale * cpu.g),
                                         std::abs(gl[2] - cpu.b) / (1 + scale * cpu.b)}));
}

// As HostPictures of images read them.
std::vector<HostRay> image_samples() {
    std::mt19937 generator(11);
    std::uniform_real_distribution<float> value(-3, 3), share(0, 1);
    std::vector<HostRay> samples;
    for (int i = 0; i < kSamples; ++i) {
        samples.push_back({{value(generator), value(generator), 0},
                           share(generator),
                           {static_cast<float>(i % 97), static_cast<float>(i % 31), 0},
                           0});
    }
    samples.push_back({{NAN, INFINITY, 0}, 0.45f, {0, 0, 0}, 0});
    return samples;
}

struct NamedImage {
    std::string name;
    opaline_gl_image on_gl;
    std::uint32_t number;
    formats::Wrap wrap_u, wrap_v;
};

std::vector<NamedImage> images_of(const Case& in, std::uint32_t p, const opaline_gl_images& gl) {
    const formats::AssetView& view = in.view();
    const auto name = [p](const char* what) {
        return "of the " + std::string(what) + " of primitive " + std::to_string(p) + ", sample";
    };
    const formats::PrimitiveRecord& primitive = view.primitives[p];
    std::vector<NamedImage> images{{name("base colour"), gl.base_color, primitive.base_color_image,
                                    primitive.wrap_u, primitive.wrap_v}};
    if (!view.gloss.empty()) {
        const formats::GlossRecord& gloss = view.gloss[p];
        images.push_back({name("gloss"), gl.gloss, gloss.image, gloss.wrap_u, gloss.wrap_v});
    }
    if (const formats::OwnLight* const own = view.emitters.own_of(p)) {
        images.push_back({name("emission"), gl.emission, own->image, own->wrap_u, own->wrap_v});
    }
    if (const formats::HoleRecord* const hole = view.holes.of(p)) {
        images.push_back({name("alpha"), gl.alpha, hole->image, hole->wrap_u, hole->wrap_v});
    }
    std::erase_if(images,
                  [](const NamedImage& image) { return image.number == formats::kNoImage; });
    return images;
}

// Whether the texture holds the image is the comparison's own affair: a missing one is a fault.
void compare_image(const Case& in, std::uint32_t p, const NamedImage& image,
                   const opaline_gl_images& gl) {
    const std::vector<HostRay> samples = image_samples();
    test::HostPicture picture = test::make_image_picture(in.api, image.on_gl, image.on_gl, gl);
    const std::vector<float> drawn = picture.draw(samples);
    const formats::PreviewImage& pixels = in.view().images[image.number];
    const formats::HoleRecord* const hole = in.view().holes.of(p);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const formats::Float2 uv{samples[i].from[0], samples[i].from[1]};
        const float* const seen = &drawn[8 * i];
        const Rgb color = runtime::sample_image_linear(pixels, uv, image.wrap_u, image.wrap_v);
        const Rgb value = runtime::sample_image_values(pixels, uv, image.wrap_u, image.wrap_v);
        in.report.compare(Kind::images, difference_of(seen, color, 0), image.name, i);
        in.report.compare(Kind::images, difference_of(seen + 4, value, 0), image.name, i);
        if (hole == nullptr) continue;
        const bool sees = runtime::sees_surface(
            *hole, samples[i].begin,
            {static_cast<std::uint32_t>(samples[i].direction[0]),
             static_cast<std::uint32_t>(samples[i].direction[1]), test::kHostTriangle});
        in.report.compare(Kind::images, sees == (seen[3] == 1) ? 0 : 1,
                          "coverage of primitive " + std::to_string(p) + ", pixel", i);
    }
}

// Receivers' normals, and light of some tenths to some multiples of what the brightest sends.
std::vector<HostRay> receivers_under_maps(const Case& in, const formats::PrimitiveRecord& primitive,
                                          float brightest) {
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> value(-2, 2), share(0, 1);
    std::uniform_int_distribution<std::uint32_t> vertex(0, primitive.vertex_count - 1);
    std::vector<HostRay> samples;
    for (int i = 0; i < kSamples; ++i) {
        const Vec3 n = in.view().normal[primitive.first_vertex + vertex(generator)];
        samples.push_back({{value(generator), value(generator), 0},
                           brightest * share(generator),
                           {n.x, n.y, n.z},
                           0});
    }
    return samples;
}

}  // namespace

void compare_images(const Case& in) {
    for (std::uint32_t p = 0; p < in.view().primitives.size(); ++p) {
        const auto gl = test::filled<opaline_gl_images>(opaline_gl_get_images, in.gl, p);
        const std::vector<NamedImage> images = images_of(in, p, gl);
        for (const NamedImage& image : images)
            compare_image(in, p, image, gl);
        if (images.empty() && in.view().holes.of(p) != nullptr) {
            in.report.note("coverage of primitive " + std::to_string(p) +
                           ", which has no image for the host's shader to read");
        }
    }
}

void compare_normal_maps(const Case& in) {
    const formats::AssetView& view = in.view();
    if (view.normal_maps.record.empty()) return;
    const std::vector<float> relit = in.file.expected(nullptr);
    const float brightest = *std::max_element(relit.begin(), relit.end());
    const runtime::TurnedLights lights = runtime::make_turned_lights(
        in.file.light()->vector(), view.primitives, view.normal_maps.record);
    for (const formats::NormalMapRecord& record : view.normal_maps.record) {
        const std::uint32_t p = record.primitive;
        const std::string name = "of primitive " + std::to_string(p) + ", sample";
        const auto map = test::filled<opaline_gl_normal_map>(opaline_gl_get_normal_map, in.gl, p);
        const std::vector<HostRay> samples =
            receivers_under_maps(in, view.primitives[p], brightest);
        test::HostPicture picture = test::make_normal_map_picture(in.api, map);
        const std::vector<float> drawn = picture.draw(samples);
        const runtime::TurnedLight* const light = lights.of(p);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const auto& d = samples[i].direction;
            const Vec3 n{d[0], d[1], d[2]};
            const Vec3 mapped = runtime::mapped_normal(
                view, record, {samples[i].from[0], samples[i].from[1]}, n, test::host_tangent(n));
            const float* const seen = &drawn[8 * i];
            in.report.compare(Kind::normal_maps,
                              difference_of(seen, {mapped.x, mapped.y, mapped.z}, 0),
                              "normal " + name, i);
            if (light == nullptr) continue;
            const float x = samples[i].begin;
            const Rgb lit = runtime::turn_light(*light, {x, 0.9f * x, 0.8f * x}, n, mapped);
            in.report.compare(Kind::normal_maps, difference_of(seen + 4, lit, 1), "light " + name,
                              i);
        }
    }
}

}  // namespace opaline::parity
