#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "bake/lab/path_images/path_image.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/bake/reference/transport_rows.h"
#include "tests/support/volumes.h"

namespace opaline::tests {

inline std::unique_ptr<ReferenceFixture> make_volume_scene(formats::Volume volume,
                                                           formats::Environment light,
                                                           Scene scene = {}) {
    if (scene.materials.empty()) {
        scene.materials.resize(1);
    }
    scene.volumes.push_back(std::move(volume));
    return make_fixture(std::move(scene), std::move(light));
}

/// A square of side 2 `half` at height y, seen from both sides.
inline Scene make_square(float y, float half = 2) {
    Primitive square;
    square.position = {{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}};
    square.normal.assign(4, {0, 1, 0});
    square.index = {0, 2, 1, 0, 3, 2};
    Scene scene = make_scene({square});
    scene.materials[0].double_sided = true;
    return scene;
}

inline runtime::Camera camera_along(glm::vec3 from, glm::vec3 direction, std::uint32_t size = 1) {
    const glm::vec3 to = from + direction;
    runtime::Camera camera;
    camera.eye = {from.x, from.y, from.z};
    camera.target = {to.x, to.y, to.z};
    camera.up = std::abs(direction.y) > 0.9f ? formats::Vec3{0, 0, 1} : formats::Vec3{0, 1, 0};
    camera.fov_y = 0.05f;
    camera.width = camera.height = size;
    return camera;
}

inline bake::PathImage draw(const ReferenceFixture& fixture, const runtime::Camera& camera,
                            const bake::PathImageOptions& options, unsigned threads = 0) {
    bake::Context context;
    context.threads = threads;
    EXPECT_TRUE(bake::check_path_scene(fixture.input));
    auto image = bake::make_path_image(fixture.scene, fixture.light, camera, options, context);
    EXPECT_TRUE(image);
    return std::move(image).value();
}

/// Radiance along one ray.
inline glm::dvec3 look_along(const ReferenceFixture& fixture, glm::vec3 from, glm::vec3 direction,
                             bake::PathImageOptions options) {
    options.rays = 1;
    const formats::Rgb c =
        draw(fixture, camera_along(from, direction), options).radiance.pixel.front();
    return {c.r, c.g, c.b};
}

/// Options of one term, as the model gives it.
inline bake::PathImageOptions plain(formats::TermSet terms) {
    bake::PathImageOptions options;
    options.terms = terms;
    options.renormalise = false;
    return options;
}

}  // namespace opaline::tests
