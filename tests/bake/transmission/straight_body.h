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

/// Material 0 of the primitives is the medium.
inline std::unique_ptr<CrossedBody> make_crossed(std::vector<Primitive> primitives, double eta,
                                                 float sigma_t) {
    auto crossed = std::make_unique<CrossedBody>();
    crossed->scene =
        make_translucent_scene(std::move(primitives), make_grey_medium(0, sigma_t, float(eta)));
    crossed->rays.emplace(bake::RayScene::build(crossed->scene, 1).value());
    crossed->sky.emplace(bake::RayScene::build({}, 1).value());
    bake::StraightBody& body = crossed->body;
    body.scene = &crossed->scene;
    body.rays = body.sky = &*crossed->rays;
    body.eta = eta;
    body.sigma_t = {sigma_t, sigma_t, sigma_t};
    body.bands = 1;
    return crossed;
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

/// What one view finds, in order of its exits.
inline std::vector<bake::StraightExit> look(const CrossedBody& crossed, glm::vec3 from,
                                            glm::vec3 seen) {
    bake::StraightLight found;
    bake::follow_straight(crossed.body, {from, 1, from}, {&seen, 1}, found);
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
    bake::follow_straight(crossed.body, {from, 1, {}}, views.seen, found);
    double mean = 0;
    for (const bake::StraightExit& exit : found.exits) {
        mean += views.weight[exit.view] * double{exit.weight[0]};
    }
    return mean;
}

}  // namespace opaline::tests
