#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/scene.h"
#include "tests/properties/things.h"

namespace opaline::tests {

/// The scene that words stand for, and what a furnace shows of it.
struct BuiltScene {
    formats::Scene scene;
    /// Of each primitive: what its vertices show of an even light of radiance 1 where nothing
    /// absorbs, below what its boundary mirrors along the normal, which rows leave out. 0: unknown.
    std::vector<double> shown;
    /// Of each vertex of each primitive: no other thing is in front of it or around it, nor touches
    /// it, so that it is seen.
    std::vector<std::vector<bool>> exposed;
    /// Lamps are in balance with light of radiance 1: they neither make anything brighter nor
    /// darker. Not points; nor what stands in two media at once, since within a medium a lamp sends
    /// out what leaves it as L / eta^2.
    bool in_balance = true;
    /// The largest radiance of what lamps send out, 1 in balance; nothing: there are points of
    /// light.
    std::optional<double> sent = 1;
    bool is_furnace = false;  ///< nothing absorbs, and lamps are in balance
};

BuiltScene build_scene(const SceneWords& words);

}  // namespace opaline::tests
