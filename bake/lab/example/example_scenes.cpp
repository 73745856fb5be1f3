#include "bake/lab/example/example_scenes.h"

#include <array>
#include <iterator>
#include <string>
#include <utility>

#include "bake/lab/example/density_fields.h"
#include "bake/lab/example/scene_parts.h"
#include "bake/lab/example/solid_mesh.h"

namespace opaline::bake {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;

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

// A table lamp with a paper shade, a panel that glows, and a ball between them.
std::vector<GltfObject> make_lamp_scene() {
    GltfObject shade{"Shade", "Paper", {1, 1, 1}, in_metres(make_shade({}))};
    shade.base_color = {0.80, 0.72, 0.60};
    shade.thin_wall = {.share = 0.5, .color = {0.74, 0.58, 0.40}};
    GltfObject bulb{"Lamp", "Bulb", {0.5, 0.5, 0.5}, in_metres(make_sphere({0, 200, 0}, 22, 3))};
    bulb.emission = {.color = {1, 0.72, 0.42}, .strength = 60};
    GltfObject panel{"Panel", "Panel", {0.1, 0.1, 0.1}, in_metres(make_panel({}))};
    panel.emission = {.color = {0.10, 0.35, 1}, .strength = 0.9};
    GltfObject wall{"Wall", "Wall", {0.62, 0.60, 0.56}, in_metres(make_wall())};
    return {std::move(shade),
            std::move(bulb),
            {"Foot", "Foot", {0.25, 0.14, 0.08}, in_metres(make_lamp_foot())},
            std::move(panel),
            ball_object("Ball", {0.75, 0.75, 0.75}, 150, {}),
            std::move(wall),
            floor_object(
                make_floor({.finest = 8.0, .fine_radius = 250.0, .growth = 0.15, .levels = 7}))};
}

// The same with a shade of wax, a body that light goes through.
std::vector<GltfObject> make_wax_lamp() {
    std::vector<GltfObject> objects = make_lamp_scene();
    constexpr double kThickness = 5;
    objects.front() = {"Shade",
                       "Wax",
                       {1, 1, 1},
                       in_metres(make_thick_shade({.around = 64, .along = 16}, kThickness))};
    return objects;
}

constexpr const char* kShadeOfWax = R"({
  "materials": {
    "Wax": {
      "sigma_s_prime": [1.05, 1.00, 0.90],
      "sigma_a": [0.0008, 0.0045, 0.026],
      "unit": "1/mm",
      "eta": 1.44,
      "roughness": 0.3
    }
  }
})";

std::vector<GltfPointLight> make_lamp_lights() {
    return {{"Spark", {1, 0.25, 0.1}, 0.02, {-0.16, 0.06, 0.14}}};
}

// In the middle of a square, counted from the board's.
constexpr double square(int number) {
    return (number + 0.5) * kSquareSide;
}

GltfObject piece_object(const char* name, std::array<double, 3> base_color, TriangleMesh mesh,
                        const GltfReflection& reflection) {
    return {name, name, base_color, in_metres(std::move(mesh)), reflection};
}

constexpr const char* kGlassOfPiece = R"({
  "materials": {
    "Glass": {
      "sigma_s": [0, 0, 0],
      "sigma_a": [0.008, 0.004, 0.003],
      "unit": "1/mm",
      "eta": 1.5,
      "roughness": 0.2
    }
  }
})";

std::vector<GltfObject> make_playing_pieces() {
    GltfObject board =
        piece_object("Board", {1, 1, 1}, make_board(), {.roughness = 0.35, .strength = 1});
    board.texcoord = board_coordinates(make_board());
    board.image = "playing-pieces.png";
    TriangleMesh table =
        make_floor({.finest = 8.0, .fine_radius = 200.0, .growth = 0.15, .levels = 7});
    for (glm::dvec3& p : table.position)
        p.y -= 12;
    constexpr GltfReflection kSatin{.metallic = 1, .roughness = 0.4, .strength = 1},
        kPolished{.metallic = 1, .roughness = 0.2, .strength = 1},
        kLacquer{.metallic = 0, .roughness = 0.25, .strength = 1};
    return {
        piece_object("Brass", {0.91, 0.78, 0.42}, make_pawn(square(-1), square(0)), kSatin),
        piece_object("Steel", {0.56, 0.57, 0.58}, make_pawn(square(1), square(-1)), kPolished),
        piece_object("Red", {0.60, 0.05, 0.04}, make_pawn(square(0), square(2)), kLacquer),
        piece_object("Black", {0.02, 0.02, 0.02}, make_pawn(square(-3), square(-2)), kLacquer),
        piece_object("Copper", {0.93, 0.62, 0.52}, make_draughtsman(square(2), square(1)), kSatin),
        piece_object("Ivory", {0.80, 0.75, 0.62}, make_draughtsman(square(-2), square(2)),
                     kLacquer),
        piece_object("Stand", {0.80, 0.75, 0.62}, make_stand(square(-1), square(2)), kLacquer),
        piece_object("Glass", {1, 1, 1}, make_squashed_ball(square(-1), square(2)), {}),
        std::move(board),
        floor_object(std::move(table))};
}

GltfObject brick_object(const char* name, std::array<double, 3> base_color, MappedMesh mapped,
                        const GltfReflection& reflection = {}) {
    GltfObject object = piece_object(name, base_color, std::move(mapped.mesh), reflection);
    object.texcoord = std::move(mapped.texcoord);
    object.normal_map = "bricks.png";
    return object;
}

// A plastered ball and a metal one before a wall, on a floor.
std::vector<GltfObject> make_bricks() {
    constexpr double kTile = 130;
    return {brick_object("Plaster", {0.70, 0.68, 0.64}, make_mapped_ball({55, 60, -30}, 60)),
            brick_object("Bronze", {0.80, 0.58, 0.35}, make_mapped_ball({-75, 45, 45}, 45),
                         {.metallic = 1, .roughness = 0.35, .strength = 1}),
            brick_object("Wall", {0.60, 0.34, 0.26},
                         make_panel({-200, 0, -140}, {400, 0, 0}, {0, 240, 0}, 48, kTile)),
            brick_object("Floor", {0.55, 0.52, 0.48},
                         make_panel({-200, 0, 200}, {400, 0, 0}, {0, 0, -340}, 64, kTile))};
}

// Each by itself on a floor of two triangles, as they leave a modeller.
std::vector<GltfObject> make_first_scene() {
    constexpr double kBall = 220, kHalf = 2000;  // [mm]
    TriangleMesh floor;
    append_grid(floor, 1, 1, {-kHalf, 0, kHalf}, {2 * kHalf, 0, 0}, {0, 0, -2 * kHalf});
    return {
        piece_object("Monkey", {0.62, 0.36, 0.20}, make_monkey_head(), {}),
        piece_object("Ball", {0.90, 0.88, 0.85}, make_sphere({720, kBall - kSink, 130}, kBall, 4),
                     {.metallic = 1, .roughness = 0.25, .strength = 1}),
        piece_object("Torus", {0.12, 0.35, 0.62}, make_torus({-560, 0, 480}, {}), {}),
        piece_object("Cube", {0.70, 0.64, 0.16}, make_cube({-680, 0, -420}, 480, 0.5), {}),
        piece_object("Plane", {0.80, 0.80, 0.80}, std::move(floor), {})};
}

constexpr double kBallRadius = 40;  // [mm]

// What smoulders, and a floor for the shadow.
std::vector<GltfObject> make_smouldering_ball() {
    return {{"Ember",
             "Ember",
             {0.11, 0.10, 0.09},
             in_metres(make_sphere(glm::dvec3(0, kBallRadius - kSink, 0), kBallRadius, 4))},
            floor_object(
                make_floor({.finest = 6.0, .fine_radius = 150.0, .growth = 0.15, .levels = 7}))};
}

formats::SparseGrid<float> make_smoke() {
    return make_smoke_density((2 * kBallRadius - 10) * kMetresPerMillimetre);
}

// Stones around a fire, on a floor.
std::vector<GltfObject> make_fireplace() {
    constexpr int kStones = 7;
    constexpr double kRing = 190, kStone = 42;  // [mm]
    std::vector<GltfObject> objects;
    for (int i = 0; i < kStones; ++i) {
        const double turn = 2 * std::numbers::pi * (i + 0.5) / kStones, size = kStone + 5 * (i % 3);
        const glm::dvec3 centre(kRing * std::sin(turn), 0.8 * size, kRing * std::cos(turn));
        objects.push_back({"Stone " + std::to_string(i + 1),
                           "Stone",
                           {0.40, 0.38, 0.35},
                           in_metres(make_sphere(centre, size, 3))});
    }
    objects.push_back(floor_object(
        make_floor({.finest = 12.0, .fine_radius = 300.0, .growth = 0.15, .levels = 7})));
    return objects;
}

constexpr std::array<double, 3> grey(double value) {
    return {value, value, value};
}

constexpr ExampleVolume make_fire() {
    return {.make = make_fire_density,
            .sigma_t = grey(40),
            .albedo = grey(0.75),
            .g = 0.4,
            .make_temperature = make_fire_temperature,
            .emission_scale = 4e-5};
}

// Skim milk of [Jensen2001] (formats/media/presets.cpp) with g = 0.9: sigma_s' / (1 - g) + sigma_a.
constexpr std::array<double, 3> kMilk{7001.4, 12202.5, 19014.2};
constexpr std::array<double, 3> kMilkAlbedo{7000 / 7001.4, 12200 / 12202.5, 19000 / 19014.2};

constexpr Example kExamples[] = {
    {{"statue", "a resting swan with thin lifted wings, the showpiece for translucent media"},
     make_statue},
    {{"knot", "a trefoil knot standing on a floor: self-shadowing and contact shadows"},
     make_trefoil},
    {{"first-scene",
      "a monkey's head, a metal ball, a torus and a cube on a plane of four vertices: what is "
      "first made in a modeller"},
     make_first_scene},
    {{"glossy", "two metal balls and a lacquered one on a glossy floor: metallic-roughness gloss"},
     make_glossy},
    {{"leaves", "a plant of eleven arched leaves: thin-walled surfaces that transmit light"},
     make_plant},
    {.info = {"lamp",
              "a lamp in a paper shade, a blue panel and a red spark: three emitters that are "
              "switched by themselves"},
     .make = make_lamp_scene,
     .make_lights = make_lamp_lights},
    {.info = {"wax-lamp",
              "the same with a shade of wax: light of an emitter through a translucent body"},
     .make = make_wax_lamp,
     .make_lights = make_lamp_lights,
     .media = kShadeOfWax},
    {.info = {"playing-pieces",
              "metal and lacquered pieces and one of rough glass on a glossy chequered board: a "
              "texture in blurred mirrors"},
     .make = make_playing_pieces,
     .media = kGlassOfPiece,
     .make_image = paint_board},
    {.info = {"bricks",
              "a matt and a metal ball between a wall and a floor of bricks: relief in a normal "
              "map"},
     .make = make_bricks,
     .make_image = paint_brick_normals},
    {{"smoke", "a plume that rises from a ball and widens as it curls: a volume beside meshes"},
     make_smouldering_ball,
     {.make = make_smoke, .sigma_t = grey(60), .albedo = grey(0.92), .g = 0.5}},
    {{"fire", "a camp fire that lights its smoke: a volume that is an emitter, alone"},
     nullptr,
     make_fire()},
    {{"campfire", "that fire among stones on a floor: light of a volume on surfaces"},
     make_fireplace,
     make_fire()},
    {{"cumulus", "a fair-weather cloud, 820 m wide: a volume alone"},
     nullptr,
     {.make = [] { return make_cumulus_density(); },
      .sigma_t = grey(0.06),
      .albedo = grey(0.999),
      .g = 0.85}},
    {{"milk", "a block of skim milk, 3 mm wide, without a boundary: a volume alone"},
     nullptr,
     {.make = make_block_density, .sigma_t = kMilk, .albedo = kMilkAlbedo, .g = 0.9}},
    {{"noise", "a cloud of noise that scatters forward in a narrow Gaussian: a volume alone"},
     nullptr,
     {.make = make_noise_density, .sigma_t = grey(80), .albedo = grey(0.995), .rms_angle = 0.11}},
    {{"stratus", "stratocumulus over an icy sea, to the horizon: a cloud layer alone"},
     nullptr,
     {},
     {.make_ground = make_icy_sea, .describe = describe_stratus}},
};

}  // namespace

std::span<const Example> all_examples() {
    return kExamples;
}

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

}  // namespace opaline::bake
