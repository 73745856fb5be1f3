#pragma once

#include <span>

#include "bake/receivers/receiver.h"
#include "bake/scene/scene_facts.h"
#include "bake/scene/texture_pyramid.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

struct DensitySpace;  // trace/density/density_space.h
struct OtherLight;    // exchange/other_light.h
struct EffectTable;

/// What all stages of a bake share, read-only: inspected and placed once, then handed on.
struct BakeInputs {
    const EffectTable& effects;
    const formats::Scene& scene;  ///< its bodies face outward
    const SceneFacts& facts;
    const RayScene& rays;  ///< all triangles
    const RayScene& sky;   ///< none: what surrounds receivers that nothing occludes
    std::span<const ReceiverSet> receivers;  ///< in the order of the scene's primitives
    /// Besides that of the environment; null: there is none.
    const OtherLight* light = nullptr;
    /// Of textures that what a bake integrates over is filtered by; null: looked up at points.
    const ScenePyramids* textures = nullptr;
    /// Volumes between the sky and what is lit by it, as truths see them; null: none. Rows are
    /// completed by what volumes leave of them (complete_rows.h).
    const DensitySpace* between = nullptr;
};

}  // namespace opaline::bake
