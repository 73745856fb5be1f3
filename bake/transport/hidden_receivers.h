#pragma once

#include <vector>

#include "bake/base/context.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Every one of 16 probe rays over the hemisphere meets the back of a single-sided triangle first.
bool is_hidden(const RayScene& rays, const Receiver& receiver);

/// Vertices that lie inside a closed body, such as those of a floor under what stands on it, are
/// black, and interpolation would smear their black over the visible rest of their triangles. A
/// hidden vertex therefore gathers where its nearest visible neighbour does, with its own normal;
/// if it has none, no visible point depends on it, and it stays as it is.
///
/// Neighbours are joined by an edge within the same primitive.
/// `receivers`: one per vertex of the scene, in order.
std::vector<Receiver> take_over_hidden(const RayScene& rays, const formats::Scene& scene,
                                       std::vector<Receiver> receivers, const Context& context);

}  // namespace opaline::bake
