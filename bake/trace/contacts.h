#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/embree_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A vertex at which surfaces lie against each other: a box stands on a floor, a wall meets a
/// ceiling, bricks lie side by side. No direction is in front of all triangles that touch it, so no
/// ray can start there: light would leak in or out by rounding. It is looked at beside the vertex.
struct Contact {
    std::uint32_t vertex = 0;  ///< running number, in output order
    glm::vec3 place{0};        ///< [m], on one of the vertex's own triangles
    glm::vec3 lift{0};         ///< [m], from there in front of that triangle
};

/// Those of `vertices` (running numbers, in output order) that are contacts, in order. The place
/// lies on that triangle from which the fewest of sixteen rays meet the back of a surface first,
/// so that what is open counts and not what is covered; of equal ones on the first.
std::vector<Contact> find_contacts(const EmbreeScene& triangles, const formats::Scene& scene,
                                   std::span<const std::uint32_t> vertices, const Context& context);

/// Moves the receivers and body points of contacts there. Both: of all vertices, in output order.
void look_beside_contacts(std::span<const Contact> contacts, std::span<Receiver> outside,
                          std::span<BodyPoint> inside);

}  // namespace opaline::bake
