#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/plan/effect.h"
#include "bake/reference/reference_receivers.h"
#include "bake/reference/reference_scene.h"
#include "bake/reference/terms.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// `wanted` vertices of the scene, seen along their normals, of thin-walled surfaces every
/// other one from behind, without those where bake and reference
/// model different geometry: inside bodies, on sharp edges, less than three mean free paths above
/// another surface inside their own body, on folds thinner than a mean free path that lie on their
/// own body, or with triangles that turn more than 60 degrees from their normal.
std::vector<ReferenceReceiver> choose_model_receivers(const ReferenceScene& scene,
                                                      std::uint32_t wanted, std::uint64_t seed);

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

/// Difference of a finished file from the Monte Carlo reference (reference/): luminance along the
/// normals of held-back receivers under the published test lights, relative to the RMS of the
/// truth. The reference's own noise is subtracted.
struct ModelErrorReport {
    double rms_relative = 0;
    double ci95[2] = {0, 0};  ///< of rms_relative: bootstrap over receivers, 2.5 and 97.5 percent
    double bias = 0;          ///< mean difference over mean truth; > 0: the file is too bright
    double missing =
        0;  ///< mean over the lights: share of all light that the file does not simulate
    std::uint32_t receivers_checked = 0;
    std::uint64_t samples = 0;  ///< paths traced, over all lights and receivers
    double seconds = 0;
    std::string reference;  ///< the reference, in words
    struct Part {
        std::string name;
        double rms_relative = 0, bias = 0, missing = 0;
        double noise = 0;           ///< RMS standard error of the truth, relative to its RMS
        std::uint32_t samples = 0;  ///< paths for each receiver
    };
    std::vector<Part> by_light;
    std::vector<std::string> left_out;  ///< test lights under which the reference does not converge
    /// Light that opaque receivers mirror, relative to the RMS of its truth.
    struct Mirrored {
        double rms_relative = 0;
        double ci95[2] = {0, 0};
        double bias = 0;
        std::uint32_t receivers_checked = 0;
    };
    std::optional<Mirrored> mirrored;  ///< nothing: no receiver checked is opaque and glossy
    /// Single suns at receivers behind whose boundary light is refracted (check_suns.h); no part of
    /// rms_relative.
    struct Suns {
        static constexpr double degrees = 5;  ///< across
        double rms_relative = 0;
        double ci95[2] = {0, 0};
        double bias = 0;
        double noise = 0;  ///< RMS standard error of the truth, relative to its RMS
        std::uint32_t suns = 0;
        std::uint32_t receivers_checked = 0;
        std::uint32_t samples = 0;  ///< paths for each receiver
    };
    std::optional<Suns> suns;  ///< nothing: no receiver checked is such
};

/// Effort of the check. It counts events, not seconds, so the result does not depend on the
/// machine.
struct ModelCheckOptions {
    std::uint32_t receivers = 192;  ///< to check; fewer if the scene has fewer
    std::uint64_t seed = 0;
    /// The terms that correspond to the file's effects. Files with interreflection but without
    /// transmission hold no bounced light that crossed a body unscattered.
    TermSet simulated = TermSet::diffuse | TermSet::single | TermSet::multiple;
    /// It also holds light that volumes scatter to surfaces.
    bool lit_by_volumes = false;
    /// It also holds the part of that which surfaces had sent to the volumes.
    bool volumes_see_surfaces = false;
    double noise = 0.01;                  ///< relative to the RMS of the truth: enough for any file
    double noise_share = 0.25;            ///< relative to the difference: enough for this file
    std::uint64_t max_events = 20000000;  ///< most scatterings and surfaces met, for each light
};

/// The terms of the reference that the files of a plan hold, without mirror reflection.
TermSet held_light(const EffectTable& effects, std::span<const PlanEntry> plan);

/// Compares `asset`, baked from `scene`, with path tracing of the same terms; this measures the
/// error of diffusion and straight paths. Other light, such as interreflection, is not compared but
/// stated as `missing`; so is light of volumes that surfaces reflect on, and light that surfaces
/// send to volumes. Light that receivers mirror is left out on both sides; that of opaque ones is
/// compared by itself (`mirrored`). Receivers inside a body, on a sharp edge, or with another
/// surface close behind them in their own body are left out.
///
/// Behind a refracting boundary a path hits the sun's disc by chance only. Scenes with such bodies
/// are therefore checked without suns, also without the sun of `sky`; `suns` states these by
/// themselves. The bits are the same for any
/// number of threads. Errors: resource, interrupted.
formats::Result<ModelErrorReport> check_model(const formats::Scene& scene,
                                              const formats::AssetView& asset,
                                              const ModelCheckOptions& options,
                                              const Context& context);

}  // namespace opaline::bake
