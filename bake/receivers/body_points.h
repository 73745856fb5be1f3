#pragma once

#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Body points of all vertices, in output order, from their receivers (make_vertex_receivers). The
/// receiver's origin lies in front of its triangles; mirrored at the vertex, it lies behind them.
/// Vertices of opaque materials get no normal.
///
/// Where faces meet at a sharp edge each has a vertex with its own normal. Straight down from there
/// the path runs along the other face, through which all light scattered once comes in undimmed.
/// Models that take the surface for that of a half space count that light twice, so they look from
/// beside the vertex (`aside`): toward the middle of the vertex's own triangles, two mean free
/// paths at most.
std::vector<BodyPoint> make_body_points(const formats::Scene& scene,
                                        std::span<const Receiver> receivers);

/// The point beside a sharp edge.
BodyPoint step_aside(BodyPoint point);

/// One set for each primitive of the scene. `outside`, `inside`: of all vertices, in output order.
std::vector<ReceiverSet> make_vertex_sets(const formats::Scene& scene,
                                          std::span<const Receiver> outside,
                                          std::span<const BodyPoint> inside);

}  // namespace opaline::bake
