#pragma once

#include <glm/glm.hpp>

#include <optional>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/lab/path_images/column_field.h"
#include "bake/lab/path_images/image_lights.h"
#include "bake/physics/path_integral/quasi_path.h"
#include "runtime/picture/camera.h"

namespace opaline::bake {

/// A step along a view ray in one band, at its middle.
struct ViewStep {
    double scattered = 0;   ///< int b e^-tau ds over the step: what scatters here and is seen
    double depth = 0;       ///< b ds
    double ell = 0;         ///< int b ds from the eye
    double absorption = 0;  ///< int a ds
    double tau = 0;         ///< int c ds
};

/// The steps of a ray through all volumes, and its depths to where it ends.
struct ViewBand {
    std::vector<ViewStep> step;
    double ell = 0, tau = 0;
};
struct ViewRay {
    glm::vec3 origin{0}, direction{0, 0, 1};  ///< unit
    float entry = 0, reach = 0;               ///< [m] where density begins; where the ray ends
    std::vector<glm::vec3> position;          ///< [m] of the steps
    std::vector<ViewBand> band;

    bool is_empty() const { return position.empty(); }
};

/// Steps of at most a voxel and about a quarter of optical depth; within a step coefficients are
/// constant, and `scattered` is exact.
ViewRay march_view_ray(const VolumeSpace& space, std::span<const MediumBand> bands,
                       glm::vec3 origin, glm::vec3 direction, float reach);

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

/// Bounds of the factor.
inline constexpr double kLeastFactor = 0.5, kMostFactor = 2;

/// Factor of orders of two and more with which the ray has radiance 1 in a white furnace, where
/// nothing is absorbed: F = (1 - e^-tau - L_once) / L_often, limited to the bounds above. 1 where
/// there is nothing to scatter. `ray` holds the steps of `band` without its absorption as band
/// `number`; surfaces count as absent. `sky`: an even sky of radiance 1, with the ray's kernel.
double furnace_factor(const ScatteringSpace& space, const ViewRay& ray, const MediumBand& band,
                      std::size_t number, const SkyView& sky);

/// Factors of a picture's rays: exact at the corners of squares of pixels, linear between corners
/// at which the ray meets density.
struct FurnaceGrid {
    static constexpr std::uint32_t kPixels = 4;  ///< along an edge of a square

    std::uint32_t columns = 0, rows = 0, bands = 0;
    std::vector<double> factor;  ///< [(row * columns + column) * bands + band]; 0: no density

    /// At a place of the picture, in pixels.
    double at(double x, double y, std::size_t band) const;
};

/// `eye`: in the scene's frame.
FurnaceGrid make_furnace_grid(const ScatteringSpace& space, const runtime::Camera& camera,
                              glm::vec3 eye, const Context& context);

}  // namespace opaline::bake
