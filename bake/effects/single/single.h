#pragma once

#include "bake/effects/single/single_stage.h"
#include "bake/plan/effect.h"

namespace opaline::bake {

/// Light that scatters once inside a medium.
EffectDescriptor describe_single(Effect id);

/// Adds a receiver's rows, gathered on a cube map of size m, to rows `first` and on of a dense row
/// of a cube map at least as large (calibration times this by itself).
void add_single(const SingleBatch& batch, std::size_t place, std::uint32_t m, std::uint32_t first,
                const DenseRow& row);

}  // namespace opaline::bake
