#include "bake/example/example_scenes.h"

#include <array>
#include <string>
#include <system_error>
#include <utility>

#include "bake/example/contact.h"
#include "bake/example/floor.h"
#include "bake/example/knot.h"
#include "bake/example/leaves.h"
#include "bake/example/polygonize.h"
#include "bake/example/remesh.h"
#include "bake/example/sphere.h"
#include "bake/example/swan_field.h"

namespace opaline::bake {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;

struct Example {
    ExampleInfo info;
    std::vector<GltfObject> (*make)();
};

TriangleMesh in_metres(TriangleMesh mesh) {
    for (glm::dvec3& p : mesh.position) {
        p *= kMetresPerMillimetre;
    }
    return mesh;
}

GltfObject floor_object(TriangleMesh floor) {
    return {"Floor", "Floor", {0.50, 0.48, 0.45}, in_metres(std::move(floor))};
}

std::vector<GltfObject> make_statue() {
    const Solid swan = make_swan();
    TriangleMesh mesh = polygonize(swan.field, swan.bounds, 1.1);
    remesh(swan.field, RemeshOptions{}, mesh);
    TriangleMesh floor =
        make_floor({.finest = 1.7, .fine_radius = 55.0, .growth = 0.1, .levels = 9});
    constexpr double kGap = 0.1;  // wider than the mesh's distance from the field
    cut_at_contact(swan.field, kGap, floor);
    return {{"Statue", "Statue", {0.82, 0.81, 0.79}, in_metres(std::move(mesh))},
            floor_object(std::move(floor))};
}

std::vector<GltfObject> make_trefoil() {
    return {{"Knot", "Knot", {0.80, 0.80, 0.80}, in_metres(make_knot({}))},
            floor_object(
                make_floor({.finest = 3.2, .fine_radius = 110.0, .growth = 0.1, .levels = 9}))};
}

constexpr double kSink = 0.4;  // [mm] into the floor, so that no two faces coincide

GltfObject ball_object(const char* name, std::array<double, 3> base_color, double x,
                       const GltfReflection& reflection) {
    constexpr double kRadius = 30;  // [mm]
    TriangleMesh mesh = make_sphere(glm::dvec3(x, kRadius - kSink, 0), kRadius, 4);
    return {name, name, base_color, in_metres(std::move(mesh)), reflection};
}

std::vector<GltfObject> make_glossy() {
    GltfObject floor = floor_object(
        make_floor({.finest = 6.0, .fine_radius = 100.0, .growth = 0.15, .levels = 6}));
    floor.reflection = {.metallic = 0, .roughness = 0.4, .strength = 1};
    return {ball_object("Brass", {0.91, 0.78, 0.42}, -70,
                        {.metallic = 1, .roughness = 0.3, .strength = 1}),
            ball_object("Lacquer", {0.60, 0.05, 0.04}, 0,
                        {.metallic = 0, .roughness = 0.3, .strength = 1}),
            ball_object("Steel", {0.56, 0.57, 0.58}, 70,
                        {.metallic = 1, .roughness = 0.6, .strength = 1}),
            std::move(floor)};
}

std::vector<GltfObject> make_plant() {
    GltfObject leaves{"Leaves", "Leaf", {0.12, 0.20, 0.05}, in_metres(make_leaves({}))};
    leaves.thin_wall = {.share = 0.5, .color = {0.16, 0.34, 0.03}};
    return {std::move(leaves),
            floor_object(
                make_floor({.finest = 4.0, .fine_radius = 110.0, .growth = 0.15, .levels = 7}))};
}

constexpr Example kExamples[] = {
    {{"statue", "a resting swan with thin lifted wings, the showpiece for translucent media"},
     make_statue},
    {{"knot", "a trefoil knot standing on a floor: self-shadowing and contact shadows"},
     make_trefoil},
    {{"glossy", "two metal balls and a lacquered one on a glossy floor: metallic-roughness gloss"},
     make_glossy},
    {{"leaves", "a plant of eleven arched leaves: thin-walled surfaces that transmit light"},
     make_plant},
};

}  // namespace

std::span<const ExampleInfo> list_examples() {
    static constexpr auto kInfos = [] {
        std::array<ExampleInfo, std::size(kExamples)> infos{};
        for (std::size_t i = 0; i < infos.size(); ++i) {
            infos[i] = kExamples[i].info;
        }
        return infos;
    }();
    return kInfos;
}

formats::Result<std::vector<GltfObject>> make_example(std::string_view name) {
    std::string known;
    for (const Example& example : kExamples) {
        if (example.info.name == name) return example.make();
        known += (known.empty() ? "" : ", ") + std::string(example.info.name);
    }
    return formats::make_error(formats::ErrorKind::usage, "", "",
                               "there is no example '" + std::string(name) + "'",
                               "choose one of: " + known);
}

formats::Result<std::vector<std::filesystem::path>> write_example(
    std::string_view name, const std::filesystem::path& folder) {
    formats::Result<std::vector<GltfObject>> objects = make_example(name);
    if (!objects) return std::move(objects).error();
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) {
        return formats::make_error(formats::ErrorKind::resource, folder.string(), "",
                                   "cannot create the folder: " + failure.message(),
                                   "choose a folder you may write to");
    }
    return write_gltf(folder, std::string(name), *objects);
}

}  // namespace opaline::bake
