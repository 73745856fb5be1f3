#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "bake/path_images/column_field.h"
#include "bake/path_images/image_lights.h"
#include "bake/path_images/sky_view.h"
#include "bake/path_images/view_ray.h"
#include "bake/path_integral/quasi_path.h"

namespace opaline::bake {

/// Volumes, their light, and what is known of both before any ray is marched.
struct ScatteringSpace {
    const VolumeSpace& volumes;
    std::vector<MediumBand> bands;
    ImagePhase phase;
    ImageLights lights;
    ColumnField sun_field;           ///< toward the suns
    ColumnField cell_field;          ///< toward the cells of the sky
    MarchLimits limits;              ///< of paths
    std::vector<double> lengths{1};  ///< of turns, in scattering depths of the view ray
    /// Fidelity "paper": the phase function's, of the attenuation by which one length is chosen.
    std::optional<double> curvature = std::nullopt;
};

/// How light that was scattered twice or more is found.
enum class PathForm {
    ray,    ///< paths from where the view ray enters: their radiance
    source  ///< paths from points along the view ray: source radiance, to be summed along the ray
};

/// Radiance along a view ray [W m^-2 sr^-1] per channel of the light, as a medium of one band
/// scatters it.
struct RayLight {
    glm::dvec3 once{0}, often{0};
};

/// What to gather: `band` is that of `steps`. `suns`: false leaves them out. `is_open`: no surface
/// ends the ray, so that light comes from straight ahead.
struct ScatterOptions {
    const MediumBand& band;
    const ViewBand& steps;
    PathForm form = PathForm::ray;
    Shadows shadows = Shadows::of_everything;
    bool suns = true, is_open = true, often = true;
};

/// `sky`: as the ray sees it, made with the kernel of the form. Order 1 is the integral along the
/// ray ([Premoze2003] (15) to (17)); orders of two and more are corrected (18), see README.md. With
/// fidelity "paper" `sky` is made with the kernel of the boundary, the form is PathForm::ray, and
/// `often` holds all that is scattered of the sky (20, 21).
RayLight gather_scattered(const ScatteringSpace& space, const ViewRay& ray, const SkyView& sky,
                          const ScatterOptions& options);

}  // namespace opaline::bake
