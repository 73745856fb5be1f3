#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace opaline::tests {

enum class ThingKind : std::uint8_t {
    opaque,
    metal,
    coat,
    double_sided,
    pane,  // thin glass
    sheet,
    medium,
    clear,
    core,  // a medium with another one in it
    volume,
    glow,  // a volume that glows by its absorption
    lamp,  // a black surface of radiance 1
    bulb,  // a point light
    copy   // of the one before it: the same mesh and material, as by another node
};
enum class Shape : std::uint8_t { box, ball, quad, plate, cup, shell, triangle };
enum class Flaw : std::uint8_t {
    none,
    slivers,
    twice,    // some triangles
    no_area,  // of some triangles
    flap,     // an edge of three triangles
    open,     // a triangle is missing
    inside_out
};
/// Where a thing stands: beside the one before it, at a distance or by a face, an edge or a corner;
/// reaching into it; at its place; within it.
enum class Place : std::uint8_t { apart, face, edge, corner, overlap, same, inside };

/// One thing in cubes of half edge `size`.
struct Thing {
    ThingKind kind = ThingKind::opaque;
    Shape shape = Shape::box;
    Flaw flaw = Flaw::none;
    Place place = Place::apart;
    int side = 0;  ///< of the one before it: 0 to 5
    bool mirrored = false;
    double size = 1;    ///< > 0
    double albedo = 1;  ///< in [0, 1]: of a surface, or of one scattering
    double depth = 1;   ///< mean free paths along `size`, > 0
    double g = 0;
    double eta = 1.3;
    double roughness = 0;
};

/// How a scene is baked once more (bake_again.h).
enum class Again : std::uint8_t {
    never,
    threads,    // by three threads
    scaled,     // by 1024 or 1/1024, a power of two: roundings stay the same
    turned,     // by a third of a turn, the light with it
    mirrored,   // the light with it
    reordered,  // things, materials and volumes from the last to the first
    unwelded,   // each triangle has vertices of its own
    split,      // each mesh in two primitives
    darker      // all absorb more
};

/// A scene in words: text and back. All lengths are multiplied by `scale` [m] and all is `distance`
/// [m] away from the world's origin.
struct SceneWords {
    double scale = 1, distance = 0;
    bool turned = false;  ///< the scene as a whole, so that what touches is off by roundings
    Again again = Again::never;
    std::vector<Thing> things;
};

/// One line from which parse_scene makes the same scene.
std::string describe(const SceneWords& scene);
/// Throws std::invalid_argument where the text is no scene.
SceneWords parse_scene(const std::string& text);

/// The scene of a seed: 1 to 12 things, baked twice. Half of all absorb nothing.
SceneWords random_scene(std::uint64_t seed);

/// Whether light may get lost in it: by absorption, at the backs of surfaces, through holes.
bool absorbs(const Thing& thing);

}  // namespace opaline::tests
