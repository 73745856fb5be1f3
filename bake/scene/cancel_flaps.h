#pragma once

#include <cstdint>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Triangles of a medium's surface that bound nothing, or what another one bounds already.
struct Flaps {
    /// Per primitive of the scene: where such a triangle's corners begin in Primitive::index,
    /// ascending.
    std::vector<std::vector<std::uint32_t>> first_index;
    std::uint64_t pairs = 0;    ///< that face opposite ways
    std::uint64_t repeats = 0;  ///< of a triangle that stays
};

/// Triangles of a medium's surface with the same three corners that face opposite ways: what is
/// left of a thin part once a mesh was simplified, or where two bodies of one medium touch, which
/// become one. Nothing lies between them, yet a ray that meets
/// two surfaces at one distance finds either of them and takes the inside for the outside. Vertices
/// at one position are one point. No pairs are found where they are more than half of the surface
/// by area: then they are the body, a sheet or one that was modelled with two sides. Repeats have
/// the same corners as another one and face the same way: faces or whole objects that were copied
/// and left in place. They would tear the surface apart, as no two of four triangles at an edge
/// belong to each other, and a ray would enter the body twice. A patch of them stays where the
/// surface would have more open edges without it.
Flaps find_flaps(const formats::Scene& scene, std::uint32_t material);

/// The scene without them. Vertices stay.
void remove_flaps(const Flaps& flaps, formats::Scene& scene);

}  // namespace opaline::bake
