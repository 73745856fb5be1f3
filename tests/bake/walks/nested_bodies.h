#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "bake/effects/multiple/walks/find_hit.h"
#include "tests/bake/walks/body_walks.h"
#include "tests/support/touching_bodies.h"

namespace opaline::tests {

/// The first part, for walks that pass through all others.
inline std::unique_ptr<WalkedBody> make_nested_body(std::vector<Part> parts, bool grey = true) {
    std::vector<std::uint32_t> inner;
    for (std::uint32_t m = 1; m < parts.size(); ++m) {
        inner.push_back(m);
    }
    return make_walked_scene(make_nested_scene(std::move(parts)), grey, inner);
}

/// Where a line from outside first meets the body.
inline bake::WalkStart start_at(const bake::WalkSpace& space, glm::vec3 from, glm::vec3 along) {
    bake::WalkHit hit;
    EXPECT_TRUE(bake::find_hit(space, from, along, 1e30f, hit));
    return {hit.position - 2 * hit.error * hit.flat, bake::smooth_normal(space, hit), hit.flat, 1};
}

}  // namespace opaline::tests
