#pragma once

#include <memory>
#include <optional>

#include "bake/reference/reference_scene.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The scenes with which surfaces of a file are compared. Volumes of a file dim light between
/// surfaces, but scatter none of it.
struct ModelScenes {
    std::unique_ptr<const formats::Scene> facing;     ///< bodies face outward
    std::unique_ptr<const formats::Scene> absorbing;  ///< null: there are no volumes
    ReferenceScene whole;
    /// With volumes that scatter nothing, of the extinction without their forward peaks, as files
    /// have it. Nothing: `whole` holds.
    std::optional<ReferenceScene> without_scattering;

    const ReferenceScene& held() const { return without_scattering ? *without_scattering : whole; }
};

/// Errors: resource.
formats::Result<ModelScenes> make_model_scenes(const formats::Scene& scene, unsigned threads);

}  // namespace opaline::bake
