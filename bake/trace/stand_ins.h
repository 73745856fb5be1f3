#pragma once

#include <cstdint>
#include <vector>

#include "bake/base/context.h"
#include "bake/scene/scene_facts.h"
#include "bake/trace/bodies_at.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Of each vertex of the scene the one at whose place its light is gathered: its own number, but
/// for vertices of media that lie in or against another body with all their triangles, or that have
/// no triangle left (cancel_flaps.h). Nobody sees these, but triangles interpolate between them and
/// others. They take the nearest vertex of their material that is seen, twice as near where it
/// faces another way. Where there is none they stay.
std::vector<std::uint32_t> find_stand_ins(const formats::Scene& scene, const SceneFacts& facts,
                                          const EmbreeScene& triangles, const Context& context);

}  // namespace opaline::bake
