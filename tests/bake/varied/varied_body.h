#pragma once

#include <utility>

#include "tests/bake/reference/reference_support.h"
#include "tests/bake/walks/body_walks.h"
#include "tests/support/varied_media.h"

namespace opaline::tests {

/// A ball of a medium, mapped along x.
inline Scene make_mapped_ball(const formats::Medium& medium, int levels = 3) {
    Primitive ball = make_sphere(levels);
    map_along_x(ball);
    Scene scene = make_translucent_scene({std::move(ball)}, medium);
    scene.materials[0].medium->variation.emplace();
    return scene;
}

inline formats::Variation& variation_of(Scene& scene) {
    return *scene.materials[0].medium->variation;
}

/// A rod from x = -1 to 1, 0.1 wide, whose density rises evenly along x: almost nowhere is its side
/// farther than its end.
inline constexpr float kRodHalfWidth = 0.05f;
inline Scene make_rod(const formats::Medium& medium) {
    Primitive rod = make_cube(1, false);
    map_along_x(rod);
    for (glm::vec3& p : rod.position) {
        p *= glm::vec3(1, kRodHalfWidth, kRodHalfWidth);
    }
    Scene scene = make_translucent_scene({std::move(rod)}, medium);
    scene.materials[0].medium->variation.emplace();
    variation_of(scene).density = add_inner_texture(scene, make_rising_image());
    return scene;
}

}  // namespace opaline::tests
