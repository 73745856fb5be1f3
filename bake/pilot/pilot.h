#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/measure/measure_error.h"
#include "bake/measure/test_lights.h"
#include "bake/plan/knobs.h"
#include "bake/plan/row_layout.h"
#include "bake/receivers/receiver.h"
#include "bake/translucent/media_stages.h"
#include "bake/visibility/ray_scene.h"

namespace opaline::bake {

/// What the pilot looks at: all vertices, and what goes by material.
struct PilotScene {
    const formats::Scene& scene;
    const RayScene& rays;  ///< what surrounds all receivers
    const RayScene& sky;   ///< without a triangle: what surrounds those that nothing occludes
    std::span<const Receiver> receivers;  ///< without a normal where no diffuse row is simulated
    std::span<const Receiver> vertices;
    std::span<const BodyPoint> points;
    std::span<const RowLayout> layouts;
    const MediaProfiles& profiles;

    /// Occluders of the light that reaches a material; the empty sky where nothing occludes it.
    const RayScene& rays_of(std::uint32_t material) const {
        return layouts[material].occluded ? rays : sky;
    }
    /// Triangles that the rows of a medium are traced against. Single scattering needs the body's
    /// own far side even where nothing occludes the light.
    const RayScene& rays_in_medium(std::uint32_t material) const {
        return layouts[material].local ? rays_of(material) : rays;
    }
};

/// A receiver and what it truly sends out under each test light, whatever the knobs.
struct PilotReceiver {
    std::uint32_t vertex = 0, material = 0;
    TwoEstimates truth;
};

/// Some of the receivers, 64 to 1024 (in media 192), drawn apart from those of the self-check.
/// Receivers that nothing is simulated for are left out. `lights`: of any cube map size. Fewer if
/// cancelled.
std::vector<PilotReceiver> find_pilot_truth(const PilotScene& pilot, const Knobs& knobs,
                                            std::span<const TestLight> lights,
                                            const Context& context);

/// How rows are kept.
struct Encoding {
    std::uint32_t coefficients = 0, code_bits = 8;

    bool operator==(const Encoding&) const = default;
};
inline constexpr Encoding kUnencoded{kAllCoefficients, 16};

/// What the opaque receivers err by however their rows are kept. Besides that only the cube map
/// matters to them: they are gathered once for each size.
struct OpaquePairs {
    std::vector<Encoding> encodings;
    /// Of each encoding: one for each light, receiver by receiver, those of media left out.
    std::vector<std::vector<CheckedPair>> pairs;

    /// Precondition: it is one of them.
    const std::vector<CheckedPair>& of(const Encoding& encoding) const {
        const auto at = std::find(encodings.begin(), encodings.end(), encoding);
        return pairs[static_cast<std::size_t>(at - encodings.begin())];
    }
};

/// Opaque receivers with all coefficients and with all that may be chosen. `lights`: of
/// knobs.cubemap_size.
OpaquePairs measure_opaque(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                           const Knobs& knobs, std::span<const TestLight> lights,
                           const Context& context);

/// What the opaque receivers err by with all coefficients, as a share of what all receivers send
/// out (relative RMS): only a finer cube map lowers it.
double find_direct_floor(const OpaquePairs& opaque, std::span<const PilotReceiver> receivers);

/// One value of one knob that was tried, the others at their finest or as already chosen.
struct PilotTrial {
    std::string knob;  ///< as in knobs_json
    double value = 0;  ///< kAllCoefficients stands for all
    double error = 0;  ///< relative RMS
    std::uint32_t code_bits = 16;
};

/// What a pilot makes of a cube map and, in media, of the surface samples there are.
struct PilotChoice {
    Knobs knobs;              ///< the cheapest that meet the target; if none do, the cheapest that
                              ///< err by hardly more than the finest
    double error = 0;         ///< expected, relative RMS
    double likely = 0;        ///< one standard error above that
    bool met = false;         ///< it is likely that knobs.error_target is
    double finest_error = 0;  ///< with all coefficients and the finest knobs
    double smooth_error = 0;  ///< the same, of lights without suns
    std::vector<PilotTrial> trials;
};

/// Tries, at the cube map size and with the media's samples as they are, the other knobs that the
/// user did not fix: tolerance, depth samples, coefficients, code bits. Measures the error of each
/// value, and takes the coarsest that leave it under the target. `lights`: of knobs.cubemap_size.
/// `opaque`: measure_opaque of the same receivers, knobs and lights.
/// Precondition: knobs.error_target > 0.
PilotChoice choose_row_knobs(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                             const OpaquePairs& opaque, const Knobs& knobs,
                             const MediaStages& media, std::span<const TestLight> lights,
                             const Context& context);

}  // namespace opaline::bake
