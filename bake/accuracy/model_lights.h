#pragma once

#include <span>
#include <string>
#include <vector>

#include "bake/reference/reference_receivers.h"
#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "formats/opal/result.h"
#include "formats/scene.h"
#include "runtime/emitter_light.h"
#include "runtime/light_vector.h"
#include "runtime/specular.h"

namespace opaline::bake {

/// Whether light is refracted on its way into some medium of the scene.
bool has_refraction(const formats::Scene& scene);

/// A light under which files are compared with path tracing.
struct ModelLight {
    std::string name;
    formats::Environment environment;
};

/// The published lights under which path tracing of the scene converges. Behind a refracting
/// boundary a path hits the sun's disc by chance only: without discs there, and `left_out` names
/// what that changed. Errors: as make_environment.
formats::Result<std::vector<ModelLight>> make_model_lights(const formats::Scene& scene,
                                                           std::vector<std::string>& left_out);

/// One light, as files of one cube map size take it.
struct FileLight {
    const runtime::LightVector& vector;
    const runtime::SpecularLight* mirrored = nullptr;  ///< not null: mirrored light alone
    runtime::EmitterLight emitters = runtime::dark_emitters();
};

/// The file's luminance along the normals, in the order of the receivers.
std::vector<double> relight_receivers(const formats::AssetView& asset,
                                      std::span<const ReferenceReceiver> receivers,
                                      const FileLight& light);

}  // namespace opaline::bake
