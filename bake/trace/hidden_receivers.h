#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/receivers/receiver.h"
#include "bake/scene/scene_facts.h"
#include "bake/trace/bodies_at.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Sixteen cosine-weighted directions around a normal, on a golden-angle spiral.
std::array<glm::vec3, RayPacket::kSize> probe_directions(glm::vec3 normal);

/// Every one of 16 probe rays over the hemisphere meets the back of a triangle that hides first.
bool is_hidden(const RayScene& rays, const Receiver& receiver);

/// Vertices inside a closed body are black, such as floor vertices under a statue. Interpolation
/// would spread the black over the visible parts of their triangles. A hidden vertex therefore
/// gathers at the origin of its nearest visible neighbour, with its own normal: of those to which
/// the way is seen in part, if there are any, so that a floor's vertex below a wall takes the side
/// on which its triangles show. A hidden vertex without a visible neighbour stays as it is, because
/// no visible point depends on it.
///
/// Neighbours are joined by an edge within the same primitive.
/// `receivers`: one per vertex of the scene, in order.
std::vector<Receiver> replace_hidden_receivers(const RayScene& rays, const formats::Scene& scene,
                                               std::vector<Receiver> receivers,
                                               const Context& context);

/// Of each vertex of the scene the one at whose place its light is gathered: its own number, but
/// for vertices of media that lie in or against another body with all their triangles, or that have
/// no triangle left (cancel_flaps.h). Nobody sees these, but triangles interpolate between them and
/// others. They take the nearest vertex of their material that is seen, twice as near where it
/// faces another way. Where there is none they stay.
std::vector<std::uint32_t> find_stand_ins(const formats::Scene& scene, const SceneFacts& facts,
                                          const EmbreeScene& triangles, const Context& context);

}  // namespace opaline::bake
