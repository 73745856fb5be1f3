#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "bake/base/context.h"
#include "bake/check/check_model.h"
#include "bake/reference/path.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Compares a file with path tracing under single suns at those of `receivers` (along their
/// normals) that have a refracting boundary. Refraction bends the way from a scattering to a sun,
/// so paths hit it by chance only. The suns are therefore Suns::degrees wide and evenly spread over
/// the sphere, and every path serves all of them. Their irradiance is 1 each. Takes three times
/// `options.max_events` events. Nothing: no receiver is such. The bits are the same for any number
/// of threads. Errors: interrupted.
formats::Result<std::optional<ModelErrorReport::Suns>> check_suns(
    const ModelScenes& scenes, const formats::AssetView& asset,
    std::span<const ReferenceReceiver> receivers, const ModelCheckOptions& options,
    const Context& context);

}  // namespace opaline::bake
