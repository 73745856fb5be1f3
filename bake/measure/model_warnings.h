#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/plan/bake_plan.h"
#include "bake/plan/knobs.h"
#include "bake/plan/scene_facts.h"
#include "bake/translucent/media_stages.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Where the model is far from the truth, as far as that is known without measuring it.

/// Bodies that light crosses: a half space's profile errs there by a tenth or more
/// (thin_parts.h). `points`: of all vertices.
std::vector<formats::Diagnostic> describe_thin_bodies(const formats::Scene& scene,
                                                      const SceneFacts& facts, const RayScene& rays,
                                                      std::span<const BodyPoint> points,
                                                      const MediaStages& media, std::uint64_t seed);

/// Phase functions for which the largest number of terms is too few for the tolerance asked for.
/// Their sum is negative in some directions, and single scattering with it.
std::vector<formats::Diagnostic> describe_short_series(const formats::Scene& scene,
                                                       const std::vector<PlanEntry>& plan,
                                                       const Knobs& knobs);

}  // namespace opaline::bake
