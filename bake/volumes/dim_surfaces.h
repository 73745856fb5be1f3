#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/plan/knobs.h"
#include "bake/receivers/receiver.h"
#include "bake/volumes/sent_light.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Light that volumes scatter to the vertices of a scene.
struct VertexLight {
    const SentLight& light;
    std::span<const ReceiverSet> receivers;  ///< in the order of the scene's primitives
};

/// What encoding dimmed rows again loses, relative: RowLoss::error of each vertex, and the RMS over
/// all, in which a vertex weighs as the square of its rows.
struct DimmedError {
    std::vector<float> receivers;
    double rms_relative = 0;
};

/// The asset with the transport of each vertex multiplied by the transmittance of volumes from each
/// direction to the vertex, plus the light that they scatter to it where `sent` is not null. Exact
/// for light that a surface reflects; light that enters a body is assumed to enter where it leaves.
/// Scattered light is assumed to be even over the mean free path of a body: a row responds to its
/// irradiance as to that of an even sky. Rows of one band get three where extinctions or scattered
/// light differ by band. The primitives are those of the scene, in order. Counts `rays`. Errors:
/// resource (more than 2^32 coefficients). Stops early, with rows missing, once the context is
/// cancelled.
formats::Result<DimmedError> dim_surfaces(const formats::Scene& scene, const Knobs& knobs,
                                          const VertexLight* sent, const Context& context,
                                          formats::Asset& asset, std::uint64_t& rays);

}  // namespace opaline::bake
