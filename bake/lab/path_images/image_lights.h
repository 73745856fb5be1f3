#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/physics/path_integral/zonal_table.h"
#include "bake/physics/phase.h"
#include "formats/opal/environment.h"

namespace opaline::bake {

/// Light from one direction.
struct ImageSun {
    glm::dvec3 direction{0, 1, 0};  ///< unit, in the scene, toward the light
    glm::dvec3 irradiance{0};       ///< perpendicular to the direction [W m^-2]
};

/// Part of a sky that phase functions are evaluated toward.
struct SkyTexel {
    glm::dvec3 direction{0, 1, 0};  ///< unit, of the texel's centre
    glm::dvec3 irradiance{0};       ///< integral of radiance over its solid angle [W m^-2]
    double solid_angle = 0;         ///< [sr]
    std::uint32_t cell = 0;         ///< that it belongs to

    double brightness() const { return (irradiance.x + irradiance.y + irradiance.z) / 3; }
};

/// A sky as a finite set of directions: cube maps (formats/opal/cubemap.h) of kTexels texels a face
/// for what varies fast with direction, the phase function, and of kCells for what varies slowly
/// and is dear, paths and visibility.
struct ImageSky {
    static constexpr std::uint32_t kTexels = 16, kCells = 4, kCellCount = 6 * kCells * kCells;

    std::vector<SkyTexel> texel;  ///< none: the sky is black
};

/// Unit directions of the cells' centres: those of every sky, black ones too.
const std::array<glm::dvec3, ImageSky::kCellCount>& sky_cells();

struct ImageLights {
    std::vector<ImageSun> suns;  ///< discs of the light, and its brightest texels
    ImageSky sky;                ///< the rest
};

/// Discs of up to 3 degrees in radius are suns. Of the map, so are texels that hold more than a
/// twentieth of its flux, in the direction of their centre of flux: shadows of small lights that a
/// photograph holds stay sharp.
ImageLights make_image_lights(const formats::Environment& environment,
                              const glm::mat3& world_from_light);

/// Radiance 1 from everywhere.
ImageSky make_even_sky();

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
