#include "tests/properties/build_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>

#include "bake/scene/lobe_record.h"
#include "tests/properties/meshes.h"
#include "tests/support/media.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

using formats::Material;
using formats::Rgb;

Rgb grey(double value) {
    const auto v = static_cast<float>(value);
    return {v, v, v};
}

glm::dvec3 half_extent(const Thing& thing) {
    switch (thing.shape) {
        case Shape::quad:
        case Shape::triangle:
            return thing.size * glm::dvec3(1, 1, 0);
        case Shape::plate:
            return thing.size * glm::dvec3(1, 0.05, 1);
        case Shape::box:
        case Shape::ball:
        case Shape::cup:
        case Shape::shell:
            break;
    }
    return glm::dvec3(thing.size);
}

// Centres, each beside the one before.
std::vector<glm::dvec3> place(const std::vector<Thing>& things) {
    std::vector<glm::dvec3> at{glm::dvec3(0)};
    for (std::size_t i = 1; i < things.size(); ++i) {
        const glm::dvec3 reach = half_extent(things[i - 1]) + half_extent(things[i]);
        const int a = things[i].side % 3, b = (a + 1) % 3, c = (a + 2) % 3;
        const double sign = things[i].side < 3 ? 1 : -1;
        glm::dvec3 step(0);
        switch (things[i].place) {
            case Place::apart:
                step[a] = sign * (1.2 * reach[a] + 0.1 * things[i].size);
                break;
            case Place::corner:
                step[c] = sign * reach[c];
                [[fallthrough]];
            case Place::edge:
                step[b] = sign * reach[b];
                [[fallthrough]];
            case Place::face:
                step[a] = sign * reach[a];
                break;
            case Place::overlap:
                step[a] = sign * 0.6 * reach[a];
                break;
            case Place::inside:
                step[a] = sign * 0.1 * things[i - 1].size;
                break;
            case Place::same:
                break;
        }
        at.push_back(at.back() + step);
    }
    return at;
}

// Those that stand within the one before are half as large as it.
std::vector<Thing> with_sizes(std::vector<Thing> things) {
    for (std::size_t i = 1; i < things.size(); ++i) {
        if (things[i].place == Place::inside) things[i].size = 0.5 * things[i - 1].size;
        if (things[i].place == Place::same) things[i].size = things[i - 1].size;
    }
    return things;
}

// Whether a point, in cubes about the thing's centre, is in it or within a fiftieth of it.
bool is_at(const Thing& thing, glm::dvec3 point) {
    if (thing.kind == ThingKind::volume || thing.kind == ThingKind::glow ||
        thing.kind == ThingKind::bulb)
        return false;
    constexpr double kNear = 0.02;
    const double most = std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    switch (thing.shape) {
        case Shape::ball:
            return glm::length(point) < 1 + kNear;
        case Shape::shell:
            return glm::length(point) < 1 + kNear && glm::length(point) > 0.6;
        case Shape::cup:
            return most < 1 + kNear &&
                   !(std::max(std::abs(point.x), std::abs(point.z)) < 0.9 - kNear &&
                     point.y > kNear - 0.9);
        case Shape::quad:
        case Shape::triangle:
            return most < 1 + kNear && std::abs(point.z) < kNear;
        case Shape::plate:
            return most < 1 + kNear && std::abs(point.y) < 0.05 + kNear;
        case Shape::box:
            break;
    }
    return most < 1 + kNear;
}

bool is_body(const Thing& thing) {
    return thing.kind == ThingKind::medium || thing.kind == ThingKind::clear ||
           thing.kind == ThingKind::core;
}

// The index of what is around a lamp; nothing: there is more than one.
std::optional<double> index_around(const std::vector<Thing>& things,
                                   const std::vector<glm::dvec3>& at, std::size_t lamp) {
    double index = 1;
    bool is_outside = false, is_inside = false;
    const formats::Primitive mesh = make_mesh(things[lamp].shape);
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (!is_body(things[i])) continue;
        for (const glm::vec3 p : mesh.position) {
            const glm::dvec3 point = at[lamp] + things[lamp].size * glm::dvec3(p);
            const bool is_in = is_at(things[i], (point - at[i]) / things[i].size);
            (is_in ? is_inside : is_outside) = true;
            // Bodies smaller than the lamp may reach into it without a vertex of it in them.
            const glm::dvec3 apart = glm::abs(at[i] - at[lamp]);
            const double reach = things[i].size + things[lamp].size;
            if (!is_in && std::max({apart.x, apart.y, apart.z}) < 1.01 * reach &&
                things[i].size < things[lamp].size)
                is_inside = true;
        }
        if (is_inside && index != 1) return std::nullopt;
        if (is_inside) index = things[i].kind == ThingKind::core ? 0 : things[i].eta;
        if (is_inside && is_outside && index != 1) return std::nullopt;
        is_inside = is_outside = false;
    }
    if (index == 0 || (index != 1 && things[lamp].kind == ThingKind::glow)) return std::nullopt;
    return index;
}

// Limits that are stated (bake/effects/transmission, bake/effects/multiple/walks): light that
// crosses a body straight ends where another body begins, and all light in a body at what is no
// body.
bool loses_light_inside(const std::vector<Thing>& things, const std::vector<glm::dvec3>& at) {
    constexpr double kNear = 0.02, kDense = 3;
    for (std::size_t i = 0; i < things.size(); ++i) {
        for (std::size_t j = 0; j < things.size() && is_body(things[i]); ++j) {
            if (j == i || things[j].kind == ThingKind::lamp ||
                things[j].kind == ThingKind::volume || things[j].kind == ThingKind::glow)
                continue;
            const bool is_dense = things[i].kind == ThingKind::medium && things[i].depth > kDense;
            if (is_body(things[j]) && is_dense) continue;
            const double near = (is_body(things[j]) ? kNear : -kNear) * things[i].size;
            const glm::dvec3 gap =
                glm::abs(at[i] - at[j]) - half_extent(things[i]) - half_extent(things[j]);
            if (std::max({gap.x, gap.y, gap.z}) < near) return true;
        }
    }
    return false;
}

formats::Medium make_medium(const Thing& thing, double length) {
    const double sigma = std::min(1e12, thing.depth / length);
    const double scattered = thing.kind == ThingKind::clear ? 0 : sigma * thing.albedo;
    // Nothing scatters, nothing absorbs: as clear as a file can say (formats/gltf/README.md).
    const double absorbed =
        thing.albedo == 1 ? (scattered > 0 ? 0 : 1e-15) : sigma * (1 - thing.albedo);
    formats::Medium medium = make_grey_medium(
        static_cast<float>(scattered), static_cast<float>(absorbed), static_cast<float>(thing.eta));
    medium.roughness = static_cast<float>(thing.roughness);
    if (thing.g != 0) {
        medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
        medium.phase.g = static_cast<float>(thing.g);
    }
    return medium;
}

Material make_material(const Thing& thing, double length) {
    Material material;
    material.base_color = grey(thing.albedo);
    const auto roughness = static_cast<float>(thing.roughness);
    switch (thing.kind) {
        case ThingKind::metal:
            material.gloss = {.metallic = 1, .roughness = roughness};
            break;
        case ThingKind::coat:
            material.gloss = {.roughness = roughness,
                              .specular = 1,
                              .ior = static_cast<float>(std::max(1.0, thing.eta))};
            break;
        case ThingKind::double_sided:
            material.double_sided = true;
            break;
        case ThingKind::pane:  // as the importer makes it
            material.double_sided = true;
            material.gloss = {.roughness = roughness, .specular = 1, .ior = 0};
            material.sheet = formats::Sheet{.reflect = {0, 0, 0},
                                            .transmit = {0, 0, 0},
                                            .clear = 1,
                                            .eta = static_cast<float>(std::max(1.0, thing.eta))};
            break;
        case ThingKind::sheet:
            material.double_sided = true;
            material.sheet = formats::Sheet{.reflect = grey(0.6), .transmit = grey(0.4)};
            break;
        case ThingKind::medium:
        case ThingKind::clear:
        case ThingKind::core:
            material.base_color = {1, 1, 1};
            material.medium = make_medium(thing, length);
            break;
        case ThingKind::lamp:
            material.base_color = {0, 0, 0};
            material.emission = {1, 1, 1};
            material.double_sided = thing.shape == Shape::quad || thing.shape == Shape::triangle;
            break;
        case ThingKind::opaque:
        case ThingKind::volume:
        case ThingKind::glow:
        case ThingKind::bulb:
            break;
    }
    return material;
}

double share_below_boundary(const Thing& thing, const Material& material) {
    switch (thing.kind) {
        case ThingKind::metal:
        case ThingKind::pane:
            return 0;
        case ThingKind::coat:
            return static_cast<double>(
                formats::eval_gloss_albedo(
                    formats::make_gloss_surface(bake::make_lobe_record(material.gloss), {1, 1, 1},
                                                0, material.gloss.roughness),
                    1)
                    .diffuse);
        case ThingKind::medium:
        case ThingKind::clear:
        case ThingKind::core: {
            const double root = (thing.eta - 1) / (thing.eta + 1);
            return 1 - root * root;
        }
        case ThingKind::opaque:
        case ThingKind::double_sided:
        case ThingKind::sheet:
        case ThingKind::volume:
        case ThingKind::glow:
        case ThingKind::lamp:
        case ThingKind::bulb:
            break;
    }
    return 1;
}

formats::Volume make_volume_of(const Thing& thing, double length, const glm::dmat4& at) {
    // One voxel, a checkerboard of them, or a ball.
    formats::SparseGrid<float> grid;
    if (thing.flaw == Flaw::open) {
        grid = formats::fill_grid(glm::ivec3(0), glm::ivec3(0), 1, [](glm::ivec3) { return 1.0f; });
    } else if (thing.shape == Shape::box) {
        grid = formats::fill_grid(glm::ivec3(-2), glm::ivec3(2), 0.4, [](glm::ivec3 v) {
            return (v.x + v.y + v.z) % 2 == 0 ? 1.0f : 0.0f;
        });
    } else {
        grid = make_ball_grid(1, 0.4);
    }
    const double sigma = std::min(1e6 / (0.4 * length), thing.depth / length);
    formats::Volume volume =
        make_volume(std::move(grid), static_cast<float>(std::max(sigma, 1e-30)),
                    static_cast<float>(thing.albedo), static_cast<float>(thing.g));
    volume.density.to_scene = at * volume.density.to_scene;
    if (thing.kind == ThingKind::glow) make_it_glow(volume, glm::vec3(1));
    return volume;
}

}  // namespace

BuiltScene build_scene(const SceneWords& words) {
    const std::vector<Thing> things = with_sizes(words.things);
    const std::vector<glm::dvec3> at = place(things);
    const glm::dmat3 turn = words.turned ? glm::dmat3(some_rotation()) : glm::dmat3(1);
    BuiltScene built;
    formats::Scene& scene = built.scene;
    scene.source = "words";
    scene.origin = glm::dvec3(words.distance, -0.3 * words.distance, 0.7 * words.distance);
    std::vector<double> emission(things.size(), 1);
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (things[i].kind == ThingKind::bulb) built.in_balance = false;
        if (things[i].kind != ThingKind::lamp && things[i].kind != ThingKind::glow) continue;
        const std::optional<double> index = index_around(things, at, i);
        built.in_balance = built.in_balance && index.has_value();
        emission[i] = index.value_or(1) * index.value_or(1);
    }
    built.is_furnace = built.in_balance && std::ranges::none_of(things, absorbs) &&
                       !loses_light_inside(things, at);
    const auto add = [&](std::size_t number, formats::Primitive mesh, double size,
                         Material material) {
        const Thing& thing = things[number];
        std::vector<bool> exposed;
        const glm::dvec3 mirror(thing.mirrored ? -1 : 1, 1, 1);
        for (std::size_t v = 0; v < mesh.position.size(); ++v) {
            const glm::dvec3 point = at[number] + size * mirror * glm::dvec3(mesh.position[v]);
            bool is_free = size == thing.size;
            for (std::size_t other = 0; other < things.size() && is_free; ++other) {
                is_free = other == number ||
                          !is_at(things[other], (point - at[other]) / things[other].size);
            }
            exposed.push_back(is_free);
            mesh.position[v] = glm::vec3(words.scale * (turn * point));
            mesh.normal[v] =
                glm::vec3(glm::normalize(turn * (mirror * glm::dvec3(mesh.normal[v]))));
        }
        if (thing.mirrored) {
            for (std::size_t i = 0; i + 2 < mesh.index.size(); i += 3) {
                std::swap(mesh.index[i + 1], mesh.index[i + 2]);
            }
        }
        mesh.node = static_cast<std::uint32_t>(number);
        mesh.name = "thing " + std::to_string(number);
        mesh.material = static_cast<std::uint32_t>(scene.materials.size());
        const auto own = static_cast<float>(emission[number]);
        material.emission = own * material.emission;
        material.name = "material " + std::to_string(scene.materials.size());
        built.shown.push_back(share_below_boundary(thing, material));
        built.exposed.push_back(std::move(exposed));
        scene.primitives.push_back(std::move(mesh));
        scene.materials.push_back(std::move(material));
    };
    for (std::size_t i = 0; i < things.size(); ++i) {
        const Thing& thing = things[i];
        const double length = thing.size * words.scale;
        if (thing.kind == ThingKind::bulb) {
            const auto power = static_cast<float>(length * length);
            scene.lights.push_back({.name = "bulb " + std::to_string(i),
                                    .intensity = {power, power, power},
                                    .position = glm::vec3(words.scale * (turn * at[i]))});
        } else if (thing.kind == ThingKind::volume || thing.kind == ThingKind::glow) {
            if (scene.volumes.size() == formats::kMaxVolumes) continue;
            glm::dmat4 to_scene(length * turn);
            to_scene[3] = glm::dvec4(words.scale * (turn * at[i]), 1);
            scene.volumes.push_back(make_volume_of(thing, length, to_scene));
        } else {
            add(i, with_flaw(make_mesh(thing.shape), thing.flaw), thing.size,
                make_material(thing, length));
            if (thing.kind == ThingKind::core) {
                Thing inner = thing;
                inner.depth = 20;
                inner.eta = 1.5;
                add(i, make_sphere(1), 0.5 * thing.size, make_material(inner, length));
            }
        }
    }
    if (scene.materials.empty()) scene.materials.resize(1);
    return built;
}

}  // namespace opaline::tests
