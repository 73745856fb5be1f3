#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The surface that bounds the medium of one material, over all its primitives.
struct BodySurface {
    std::uint32_t material = 0;
    std::uint64_t turned = 0;      ///< triangles that faced inward
    std::uint64_t open_edges = 0;  ///< edges at which the surface ends
};

/// Bodies whose triangles all face outward.
struct OrientedBodies {
    std::optional<formats::Scene> scene;  ///< nothing: the scene given needs no change
    std::vector<BodySurface> surfaces;    ///< one for each medium that fills any triangle
};

/// Turns the triangles of media that face inward, and the normals of their vertices with them
/// (receivers/README.md, "Orientation"): what is behind a triangle is taken for
/// medium, so that a body turned inside out would be black.
///
/// Vertices in one place are one. Triangles that share an edge with one other belong to one shell,
/// which is made to face one way, that of the larger area; then to enclose a positive volume. A
/// shell that lies within another of the same material keeps its direction relative to it: it is a
/// cavity if it faces the other way. Shells without volume, as sheets, are left as they are, and so
/// are triangles without area. An edge is open if an odd number of triangles meet there.
OrientedBodies orient_bodies(const formats::Scene& scene);

/// What the user should know of: surfaces that were turned or do not close.
std::vector<formats::Diagnostic> describe_faults(const formats::Scene& scene,
                                                 const std::vector<BodySurface>& surfaces);

}  // namespace opaline::bake
