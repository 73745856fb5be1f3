#pragma once

#include <utility>
#include <vector>

#include "tests/support/scenes.h"

namespace opaline::tests {

/// The same in all three bands; coefficients in 1/m.
inline formats::Medium make_grey_medium(float sigma_s, float sigma_a, float eta = 1.3f) {
    formats::Medium medium;
    medium.sigma_s = {sigma_s, sigma_s, sigma_s};
    medium.sigma_a = {sigma_a, sigma_a, sigma_a};
    medium.eta = eta;
    return medium;
}

/// Material 0 is translucent, material 1 opaque: primitives choose by their `material`.
inline Scene make_translucent_scene(std::vector<Primitive> primitives,
                                    const formats::Medium& medium) {
    Scene scene = make_scene(std::move(primitives));
    scene.materials[0].medium = medium;
    scene.materials.push_back({.name = "Opaque"});
    return scene;
}

/// Faces and normals the other way.
inline Primitive turned_inside_out(Primitive p) {
    for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
        std::swap(p.index[i + 1], p.index[i + 2]);
    }
    for (glm::vec3& n : p.normal) {
        n = -n;
    }
    return p;
}

}  // namespace opaline::tests
