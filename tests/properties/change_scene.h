#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "formats/scene.h"
#include "tests/properties/things.h"

namespace opaline::tests {

/// A scene that must show what another one does, or less.
struct ChangedScene {
    struct Vertex {
        std::uint32_t primitive = 0, vertex = 0;
    };
    formats::Scene scene;
    /// Of each vertex of each primitive: that of the scene before.
    std::vector<std::vector<Vertex>> before;
    /// Points of the scene before become scale * turn * point, directions turn * direction. The
    /// light turns with them.
    double scale = 1;
    glm::dmat3 turn{1};
};

/// The same scene where `again` says that it is baked once more as it is.
ChangedScene change_scene(const formats::Scene& scene, Again again);

}  // namespace opaline::tests
