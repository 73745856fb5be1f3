#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bake/effects/transmission/straight_paths.h"
#include "bake/effects/transmission/view_fit.h"
#include "tests/support/media.h"

namespace opaline::tests {

/// A body of a grey medium and what light needs that crosses it.
struct CrossedBody {
    Scene scene;
    std::optional<bake::RayScene> rays, sky;
    bake::StraightBody body;
};

/// The first material of the scene and all other media. `meets`: of StraightBody.
inline std::unique_ptr<CrossedBody> make_crossed_scene(Scene scene, bool meets = false) {
    auto crossed = std::make_unique<CrossedBody>();
    crossed->scene = std::move(scene);
    crossed->rays.emplace(bake::RayScene::build(crossed->scene, 1).value());
    crossed->sky.emplace(bake::RayScene::build({}, 1).value());
    std::vector<std::uint32_t> inner;
    for (std::uint32_t m = 1; m < crossed->scene.materials.size(); ++m) {
        if (crossed->scene.materials[m].medium) inner.push_back(m);
    }
    crossed->body = bake::make_straight_body(crossed->scene, *crossed->rays, 0, inner, meets);
    crossed->body.bands = 1;
    return crossed;
}

/// Material 0 of the primitives is the medium.
inline std::unique_ptr<CrossedBody> make_crossed(std::vector<Primitive> primitives, double eta,
                                                 float sigma_t) {
    return make_crossed_scene(
        make_translucent_scene(std::move(primitives), make_grey_medium(0, sigma_t, float(eta))));
}

/// A slab between y = 0 and y = -thickness, practically without an end. Its last vertex lies within
/// its upper face, of no triangle.
inline Primitive make_crossed_slab(float thickness) {
    Primitive slab = make_cube(1, false);
    for (glm::vec3& p : slab.position) {
        p = (p + glm::vec3(0, -1, 0)) * glm::vec3(400, 0.5f, 400) * thickness;
    }
    slab.position.push_back(thickness * glm::vec3(5, 0, 3));
    slab.normal.emplace_back(0, 1, 0);
    return slab;
}

/// In the first material alone, or in all bodies around the point.
inline bake::StraightStart start_in(const CrossedBody& crossed, glm::vec3 from, glm::vec3 vertex) {
    const bake::StraightBody& body = crossed.body;
    const std::uint16_t own = body.place_of[0];
    return {from,
            body.bodies ? bake::bodies_at_start(*body.bodies, body.place_of, own, from)
                        : bake::MediumStack(own, 1),
            vertex};
}

/// What one view finds, in order of its exits.
inline std::vector<bake::StraightExit> look(const CrossedBody& crossed, glm::vec3 from,
                                            glm::vec3 seen) {
    bake::StraightLight found;
    bake::follow_straight(crossed.body, start_in(crossed, from, from), {&seen, 1}, found);
    return found.exits;
}

inline double sum_of(const std::vector<bake::StraightExit>& exits) {
    double sum = 0;
    for (const bake::StraightExit& exit : exits) {
        sum += double{exit.weight[0]};
    }
    return sum;
}

/// Of what one band shows of an even light from `from`, over the views.
inline double mean_over(const CrossedBody& crossed, glm::vec3 from,
                        const bake::TransmissionViews& views) {
    bake::StraightLight found;
    bake::follow_straight(crossed.body, start_in(crossed, from, {}), views.seen, found);
    double mean = 0;
    for (const bake::StraightExit& exit : found.exits) {
        mean += views.weight[exit.view] * double{exit.weight[0]};
    }
    return mean;
}

}  // namespace opaline::tests
