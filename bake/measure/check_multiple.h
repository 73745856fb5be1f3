#pragma once

#include <cstdint>
#include <span>

#include "bake/base/context.h"
#include "bake/measure/measure_error.h"
#include "bake/measure/test_lights.h"
#include "bake/multiple/gather_multiple.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// Checks, among the receivers `drawn`, those of the material `material` against the sum over every
/// surface sample, with what each lets in under each light before anything was truncated:
/// `transport.response` to the coarse vectors of `lights`.
EffectCheck check_multiple(const ClusterTree& tree, const GatherProfile& profile, double exit,
                           const SampleTransport& transport, std::uint32_t material,
                           const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                           std::span<const TestLight> lights, const Context& context);

}  // namespace opaline::bake
