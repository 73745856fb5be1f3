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
    std::uint64_t flaps = 0;       ///< pairs of triangles that bound nothing, removed
    std::uint64_t repeats = 0;     ///< triangles that lie on another one, removed
};

/// Bodies whose triangles all face outward and bound them.
struct OrientedBodies {
    std::optional<formats::Scene> scene;  ///< nothing: the scene given needs no change
    std::vector<BodySurface> surfaces;    ///< one for each medium that fills any triangle
};

/// Turns the triangles of media that face inward, and the normals of their vertices with them
/// (README.md, "Orientation"): the medium lies behind its triangles, so a body turned
/// inside out would be black. Of double-sided opaque surfaces, closed shells with nothing wholly
/// inside are turned outward, too, and a material of such alone has one side. Where it has others,
/// it becomes a sheet that transmits nothing, which has light on each of its sides.
///
/// Seams that rounding opened are closed (weld.h). Vertices at one position are one point.
/// Triangles that share an edge with exactly one other form a shell. A shell is turned to the
/// direction of its larger area, then to a positive volume. A shell inside another of the same
/// material keeps its direction relative to that one; facing the other way makes it a cavity. Flaps
/// (cancel_flaps.h) are removed first. Shells without volume (sheets) and triangles without area
/// stay as they are. An edge is open if an odd number of triangles meet there.
OrientedBodies orient_bodies(const formats::Scene& scene);

/// Warnings about surfaces that were turned, have flaps or do not close.
std::vector<formats::Diagnostic> describe_faults(const formats::Scene& scene,
                                                 const std::vector<BodySurface>& surfaces);

}  // namespace opaline::bake
