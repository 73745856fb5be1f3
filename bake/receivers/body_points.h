#pragma once

#include <span>
#include <vector>

#include "bake/receivers/receiver.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Body points of all vertices, in output order, from their receivers (make_vertex_receivers). The
/// receiver's origin lies in front of its triangles; mirrored at the vertex, it lies behind them.
/// Vertices of opaque materials get no normal.
std::vector<BodyPoint> make_body_points(const formats::Scene& scene,
                                        std::span<const Receiver> receivers);

/// One set for each primitive of the scene. `outside`, `inside`: of all vertices, in output order.
std::vector<ReceiverSet> make_vertex_sets(const formats::Scene& scene,
                                          std::span<const Receiver> outside,
                                          std::span<const BodyPoint> inside);

}  // namespace opaline::bake
