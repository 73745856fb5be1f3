#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "tests/properties/things.h"

namespace opaline::tests {

/// A thing where it stands.
struct PlacedThing : Thing {
    std::size_t source = 0;  ///< the thing that it is a copy of, or itself
    glm::dvec3 at{0};        ///< its centre
};

/// Copies are what they copy, at the size that they have; a copy of nothing is plain. Those that
/// stand within the one before are half as large as it.
std::vector<PlacedThing> place_things(const std::vector<Thing>& things);

/// A thing that a medium fills.
bool is_body(const Thing& thing);

/// Whether a point is in a thing or within a fiftieth of its size of it.
bool is_at(const PlacedThing& thing, glm::dvec3 point);

/// The index of what is around a lamp; nothing: there is more than one.
std::optional<double> index_around(const std::vector<PlacedThing>& things, std::size_t lamp);

/// Limits that are stated (bake/effects/transmission, bake/effects/multiple/walks): light that
/// crosses a body straight ends where a body begins whose light scatters, or the other way round,
/// and all light in a body at what is no body.
bool loses_light_inside(const std::vector<PlacedThing>& things);

}  // namespace opaline::tests
