#pragma once

#include <array>
#include <glm/glm.hpp>
#include <span>

#include "bake/path_images/image_lights.h"
#include "bake/path_integral/zonal_table.h"
#include "bake/scattering/phase.h"

namespace opaline::bake {

/// A phase function, ready for pictures: of all volumes of a scene.
struct ImagePhase {
    PhaseDensity density;
    /// Kernels of two scatterings or more, and with fidelity "paper" of one or more from the
    /// boundary; then there is none of the source.
    ZonalTable ray, source, boundary;
};
/// `paper`: directions along paths by a power of the phase function.
ImagePhase make_image_phase(const formats::PhaseFunction& phase, bool paper);

/// What a view ray sees of a part of the sky, texel by texel: only paths and visibility are those
/// of the part's middle.
struct SkyPart {
    glm::dvec3 once{0};   ///< sum of phase function times irradiance, per channel [W m^-2 sr^-1]
    glm::dvec3 color{0};  ///< irradiance over its mean over channels
    ZonalRow often;       ///< sum of kernel times that mean
    bool is_dark = true;
};

/// The cells of a sky, and last the part straight ahead, which would suffer most from being seen
/// through the middle of a cell: it is cut out of its cells.
struct SkyView {
    static constexpr std::size_t kAhead = ImageSky::kCellCount;

    std::array<SkyPart, ImageSky::kCellCount + 1> part;
};

/// Texels within this angle of the view ray are ahead: half a cell's width [rad].
inline constexpr double kAheadAngle = 0.2;

/// `onward`: unit, away from the eye. The phase function's sum over the texels is scaled to 1, as
/// its integral is.
SkyView view_sky(const ImageSky& sky, const PhaseDensity& phase, const ZonalTable& table,
                 glm::dvec3 onward);

}  // namespace opaline::bake
