#pragma once

#include <cstdint>

#include "bake/base/context.h"
#include "bake/plan/knobs.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The asset with the transport of each vertex multiplied by what volumes let through from each
/// direction to the vertex. Exact for light that a surface reflects; light that enters a body is
/// taken to come through where it leaves. Rows of one band get three where extinctions differ by
/// band. The primitives are those of the scene, in order. Errors: resource (more than 2^32
/// coefficients). Stops early, with rows missing, once the context is cancelled.
formats::Status dim_surfaces(const formats::Scene& scene, const Knobs& knobs,
                             const Context& context, formats::Asset& asset);

}  // namespace opaline::bake
