// Figure 4 of [Suykens2001] remade: a room with a table, a diffuse ball and one of rough glass, lit
// by a lamp below the ceiling and a spot, by particles alone: elements as footprints join them,
// with their edges. usage: opaline_bench radiosity-figure OUT.png [PARTICLES]
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/lamps/onward_ray.h"
#include "bake/exchange/lamps/trace_particles.h"
#include "formats/image/png.h"
#include "formats/image/srgb.h"
#include "tests/bake/lamps/lamp_scenes.h"
#include "tests/bench/bench.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kWidth = 480, kHeight = 400, kSamples = 3;  // samples along a pixel's side
constexpr double kExposure = 1.1;

formats::Primitive box(glm::vec3 centre, glm::vec3 half) {
    formats::Primitive primitive = tests::make_cube(1, false);
    for (glm::vec3& position : primitive.position)
        position = centre + half * position;
    return primitive;
}

// Metres, y up: 4 wide, 3 high, 4 deep; open to the eye.
formats::Scene make_room() {
    formats::Scene scene;
    const auto wall = [&](formats::Primitive primitive, formats::Rgb color) {
        tests::add_surface(scene, std::move(primitive), 1).base_color = color;
    };
    wall(tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}), {0.6f, 0.6f, 0.6f});
    wall(tests::make_quad({-2, 3, -2}, {4, 0, 0}, {0, 0, 4}), {0.8f, 0.8f, 0.8f});
    wall(tests::make_quad({-2, 0, -2}, {4, 0, 0}, {0, 3, 0}), {0.8f, 0.8f, 0.8f});
    wall(tests::make_quad({-2, 0, -2}, {0, 3, 0}, {0, 0, 4}), {0.75f, 0.2f, 0.15f});
    wall(tests::make_quad({2, 0, -2}, {0, 0, 4}, {0, 3, 0}), {0.2f, 0.3f, 0.7f});
    wall(box({0, 0.95f, 0}, {1, 0.04f, 0.65f}), {0.65f, 0.5f, 0.35f});
    for (const float x : {-0.9f, 0.9f}) {
        for (const float z : {-0.55f, 0.55f})
            wall(box({x, 0.45f, z}, {0.05f, 0.45f, 0.05f}), {0.65f, 0.5f, 0.35f});
    }
    wall(tests::make_sphere(5, 0.28f, {-0.5f, 1.275f, -0.1f}), {0.8f, 0.8f, 0.8f});
    formats::Primitive ball = tests::make_sphere(6, 0.3f, {0.42f, 1.4f, 0.1f});
    formats::Medium glass;
    glass.sigma_s = glass.sigma_a = {0, 0, 0};
    glass.eta = 1.5f;
    glass.roughness = 0.3f;
    tests::add_surface(scene, std::move(ball), 1).medium = glass;
    tests::add_surface(scene, tests::make_quad({-0.15f, 2.7f, -0.15f}, {0.3f, 0, 0}, {0, 0, 0.3f}),
                       0, 60);
    scene.lights.push_back({.type = formats::Light::Type::spot,
                            .intensity = {12, 11, 9},
                            .position = {0, 2.4f, 1.5f},
                            .direction = glm::normalize(glm::vec3(-0.5f, -0.15f, -1)),
                            .inner_cone = 0.15f,
                            .outer_cone = 0.3f});
    return scene;
}

struct Camera {
    glm::dvec3 eye{0.25, 2.35, 4.4}, forward = glm::normalize(glm::dvec3(-0.05, -0.27, -1));
    double half_width = 0.46;

    glm::dvec3 direction(double x, double y) const {
        const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
        const glm::dvec3 up = glm::cross(right, forward);
        return glm::normalize(forward + half_width * (2 * x / kWidth - 1) * right -
                              half_width * (2 * y - kHeight) / kWidth * up);
    }
};

/// What the eye sees of a scene's elements.
struct View {
    const formats::Scene& scene;
    const RayScene& rays;
    const ElementLayout& layout;
    Camera camera;

    std::optional<Arrival> look(double x, double y) const {
        return find_arrival(rays, glm::vec3(camera.eye), glm::vec3(camera.direction(x, y)));
    }
};

using Picture = std::vector<glm::dvec3>;

template <class Shade>
Picture render(Shade&& shade) {
    Picture picture(std::size_t{kWidth} * kHeight);
    for_each_block_in_order(
        kHeight, 1, Context{},
        [&](Range range) {
            std::vector<glm::dvec3> row;
            row.reserve(kWidth);
            for (std::uint32_t x = 0; x < kWidth; ++x)
                row.push_back(shade(x, static_cast<std::uint32_t>(range.begin)));
            return row;
        },
        [&](Range range, std::vector<glm::dvec3>&& row) {
            std::ranges::copy(row,
                              picture.begin() + static_cast<std::ptrdiff_t>(range.begin * kWidth));
        });
    return picture;
}

// Irradiance times colour of elements; dark where the next sample is of another group.
glm::dvec3 shade_elements(const View& view, const ElementLight& light, std::uint32_t x,
                          std::uint32_t y) {
    struct Seen {
        std::optional<Arrival> at;
        std::uint32_t group = 0xffffffffu;
    };
    const auto look = [&](std::uint32_t i, std::uint32_t j) {
        Seen seen{view.look(x + (i + 0.5) / kSamples, y + (j + 0.5) / kSamples)};
        if (!seen.at) return seen;
        const std::size_t element = view.layout.element(seen.at->side, seen.at->weights);
        if (element < view.layout.size()) seen.group = light.together[element];
        return seen;
    };
    glm::dvec3 sum(0);
    for (std::uint32_t j = 0; j < kSamples; ++j) {
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const Seen seen = look(i, j);
            if (!seen.at || seen.group == 0xffffffffu) continue;
            const formats::Material& material = view.scene.materials[seen.at->material];
            const glm::dvec3 own(material.emission.r, material.emission.g, material.emission.b);
            const glm::dvec3 color =
                bounce_color(view.scene, seen.at->side, glm::vec3(seen.at->weights)).reflect;
            const bool is_edge =
                look(i + 1, j).group != seen.group || look(i, j + 1).group != seen.group;
            const glm::dvec3 irradiance(
                light.irradiance[view.layout.element(seen.at->side, seen.at->weights)]);
            sum += own + (is_edge ? 0.35 : 1.0) * std::numbers::inv_pi * color * irradiance;
        }
    }
    return sum / static_cast<double>(kSamples * kSamples);
}

void write(const Picture& picture, const std::string& path) {
    formats::Image image;
    image.width = kWidth;
    image.height = kHeight;
    for (const glm::dvec3& value : picture) {
        const glm::vec3 c(kExposure * value);
        image.pixel.push_back({c.x, c.y, c.z});
    }
    if (!formats::write_png(path, formats::to_srgb(image))) {
        std::fprintf(stderr, "cannot write %s\n", path.c_str());
        std::exit(4);
    }
}

void make_figure(const std::string& path, std::uint32_t particles) {
    const formats::Scene scene = make_room();
    const RayScene rays = tests::build_rays(scene);
    // One lamp of both.
    std::vector<LampSources> sources = tests::all_sources(scene);
    sources[0].lights = scene.lights;
    sources.resize(1);
    const ElementLayout layout(scene, 4 * reflecting_area(scene) / particles);
    const View view{scene, rays, layout, {}};
    std::uint64_t traced = 0;
    const ParticleLight light = trace_particles(scene, rays, sources[0], layout,
                                                {.particles = particles}, Context{}, traced);
    const ElementLight elements = layout.join(light.all);
    write(render([&](std::uint32_t x, std::uint32_t y) {
              return shade_elements(view, elements, x, y);
          }),
          path);
}

}  // namespace
}  // namespace opaline::bake

int opaline::tests::radiosity_figure(int argc, char** argv) {
    if (argc < 2 || argc > 3) {
        std::fprintf(stderr, "usage: opaline_bench radiosity-figure OUT.png [PARTICLES]\n");
        return 2;
    }
    opaline::bake::make_figure(
        argv[1],
        argc > 2 ? static_cast<std::uint32_t>(std::strtoul(argv[2], nullptr, 10)) : 400000);
    return 0;
}
