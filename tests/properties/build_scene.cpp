#include "tests/properties/build_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <utility>

#include "bake/scene/lobe_record.h"
#include "tests/properties/meshes.h"
#include "tests/properties/placed_things.h"
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
        case ThingKind::copy:
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
        case ThingKind::copy:
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
    const std::vector<PlacedThing> things = place_things(words.things);
    const glm::dmat3 turn = words.turned ? glm::dmat3(some_rotation()) : glm::dmat3(1);
    BuiltScene built;
    formats::Scene& scene = built.scene;
    scene.source = "words";
    scene.origin = glm::dvec3(words.distance, -0.3 * words.distance, 0.7 * words.distance);
    std::vector<double> emission(things.size(), 1);
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (things[i].kind == ThingKind::bulb) built.sent.reset();
        if (things[i].kind != ThingKind::lamp && things[i].kind != ThingKind::glow) continue;
        const std::optional<double> index = index_around(things, i);
        built.in_balance = built.in_balance && index.has_value();
        emission[i] = index.value_or(1) * index.value_or(1);
        // One material cannot be in balance in two media.
        built.in_balance = built.in_balance && emission[i] == emission[things[i].source];
    }
    built.in_balance = built.in_balance && built.sent;
    if (built.sent && !built.in_balance) {
        double index = 1;  // the smallest, out of which light leaves brightest
        for (const PlacedThing& thing : things) {
            if (is_body(thing)) index = std::min(index, thing.eta);
        }
        built.sent = std::ranges::max(emission) / (index * index);
    }
    built.is_furnace =
        built.in_balance && std::ranges::none_of(things, absorbs) && !loses_light_inside(things);
    std::vector<std::size_t> first_material(things.size(), 0);
    const auto add = [&](std::size_t number, std::uint32_t part, formats::Primitive mesh,
                         double size, Material material) {
        const PlacedThing& thing = things[number];
        std::vector<bool> exposed;
        const glm::dvec3 mirror(thing.mirrored ? -1 : 1, 1, 1);
        for (std::size_t v = 0; v < mesh.position.size(); ++v) {
            const glm::dvec3 point = thing.at + size * mirror * glm::dvec3(mesh.position[v]);
            bool is_free = size == thing.size;
            for (std::size_t other = 0; other < things.size() && is_free; ++other) {
                is_free = other == number || !is_at(things[other], point);
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
        mesh.mesh = static_cast<std::uint32_t>(thing.source);
        mesh.primitive = part;
        const bool is_copy = thing.source != number;
        if (part == 0) first_material[number] = scene.materials.size();
        mesh.material = static_cast<std::uint32_t>(first_material[thing.source]) + part;
        const auto own = static_cast<float>(emission[number]);
        material.emission = own * material.emission;
        material.name = "material " + std::to_string(scene.materials.size());
        built.shown.push_back(share_below_boundary(thing, material));
        built.exposed.push_back(std::move(exposed));
        scene.primitives.push_back(std::move(mesh));
        if (!is_copy) scene.materials.push_back(std::move(material));
    };
    for (std::size_t i = 0; i < things.size(); ++i) {
        const PlacedThing& thing = things[i];
        const double length = thing.size * words.scale;
        if (thing.kind == ThingKind::bulb) {
            const auto power = static_cast<float>(length * length);
            scene.lights.push_back({.name = "bulb " + std::to_string(i),
                                    .intensity = {power, power, power},
                                    .position = glm::vec3(words.scale * (turn * thing.at))});
        } else if (thing.kind == ThingKind::volume || thing.kind == ThingKind::glow) {
            if (scene.volumes.size() == formats::kMaxVolumes) continue;
            glm::dmat4 to_scene(length * turn);
            to_scene[3] = glm::dvec4(words.scale * (turn * thing.at), 1);
            scene.volumes.push_back(make_volume_of(thing, length, to_scene));
        } else {
            add(i, 0, with_flaw(make_mesh(thing.shape), thing.flaw), thing.size,
                make_material(thing, length));
            if (thing.kind == ThingKind::core) {
                Thing inner = thing;
                inner.depth = 20;
                inner.eta = 1.5;
                add(i, 1, make_sphere(1), 0.5 * thing.size, make_material(inner, length));
            }
        }
    }
    if (scene.materials.empty()) scene.materials.resize(1);
    return built;
}

}  // namespace opaline::tests
