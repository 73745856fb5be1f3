#pragma once

#include <limits>
#include <span>

#include "formats/opal/environment.h"
#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/clouds/layer_field.h"
#include "runtime/clouds/layer_light.h"

namespace opaline::runtime {

/// Albedo of the ground at (x, z), a mean over `footprint` [m]. Beyond the picture it repeats with
/// the layer, or keeps its edge.
formats::Rgb ground_albedo(const LayerLight& light, double x, double z, double footprint);

/// Radiance of the ground at (x, z), the same in all directions: albedo / pi (sum over suns of E
/// mu_l (T_0 + T_1) + RG). x, z finite [m]. `footprint`: what is averaged over [m], >= 0.
formats::Rgb see_ground(const LayerLight& light, double x, double z, double footprint);

/// Color through `distance` [m] of the record's haze, which has the sky's radiance near the
/// horizon; `share` of a view that the color covers, by band.
formats::Rgb haze_over(const LayerLight& light, formats::Rgb color, double distance,
                       formats::Rgb share = {1, 1, 1});

/// Distances t from `origin` along `direction` with begin <= t <= end [m].
struct LayerRay {
    formats::Vec3 origin;     ///< [m], world, finite
    formats::Vec3 direction;  ///< unit
    double begin = 0;         ///< not below 0
    double end = std::numeric_limits<double>::infinity();
    float spread = 0;  ///< of the pixel that the ray stands for [rad], >= 0: what lies within it is
                       ///< averaged

    double x(double t) const { return double(origin.x) + t * double(direction.x); }
    double z(double t) const { return double(origin.z) + t * double(direction.z); }
};

/// A ray through a layer: means weighted by visibility from the origin.
struct LayerMarch {
    float length = 0;     ///< inside of the layer [m]; 0: nothing is seen, and no mean is set
    double distance = 0;  ///< from the origin [m]
    float thickness = 0;  ///< [m]
    float level = 0;      ///< of the pyramid
};

/// kSteps steps along the part of the ray between the layer's base and its highest top, which grow
/// with the distance from the origin like distance + highest / 2. A step reads the thickness at its
/// ends from the level whose texels fit its horizontal length; between them it is linear, so that
/// the length inside is exact where the layer is even. A step's weight is T - T', what it takes of
/// the light behind at the extinction `kappa` [1/m]. Beyond kFarthest nothing is seen.
LayerMarch march_layer(const LayerField& field, const LayerRay& ray, float kappa);
inline constexpr int kLayerSteps = 48;
inline constexpr double kFarthest = 1e8;  ///< [m]

/// A layer along one ray as a thin sheet at its mean visible distance: nearer objects are in front
/// of all of it, farther ones behind all of it. Exact for objects that do not overlap the layer in
/// depth; continuous for objects that move through it.
struct LayerSheet {
    formats::Rgb radiance;                ///< its own light, without glow [W m^-2 sr^-1]
    formats::Rgb transmittance{1, 1, 1};  ///< exp(-tau_S), of light from behind
    float distance = 0;                   ///< from the eye [m]; 0 where the ray meets no layer

    bool is_met() const { return transmittance.g < 1; }
};

/// The sheet that several rays through a pixel see: means, of distances by what each takes of the
/// light behind it (green). Precondition: at least one.
LayerSheet mean_sheet(std::span<const LayerSheet> sheets);

/// Light that a layer adds to a ray seen from its origin, and its transmittance.
struct SeenLayer {
    formats::Rgb radiance;  ///< its own light, in its haze [W m^-2 sr^-1]
    /// Light of the suns that droplets scatter by less than the peak's angle, which is taken to go
    /// straight on: only for rays that end in the sky [W m^-2 sr^-1].
    formats::Rgb glow;
    formats::Rgb transmittance{1, 1, 1};      ///< exp(-tau_S): of ground, surfaces, sky
    formats::Rgb sun_transmittance{1, 1, 1};  ///< exp(-tau): of a sun's disc
    double distance = 0;                      ///< mean visible distance [m]; 0: no layer
};

/// The layer as a plane slab of the thickness that the ray sees (see_layer.h), whose light is
/// taken as that of a source: radiance (1 - exp(-tau_S)) / (1 - exp(-kappa_S H / mu_v)) L_slab(H,
/// mu_v, mu_l), so that an even layer is the slab and edges fade. Looking down L_slab is what the
/// slab reflects, with the normal of its top in single scattering; looking up what it transmits.
/// README.md, "Along a ray". Any finite ray gives finite values, not negative.
SeenLayer see_layer(const LayerLight& light, const LayerRay& ray);

/// A layer, the ground and the environment that lights them; refers to all.
struct LayerScene {
    const LayerLight& light;
    const formats::Environment& environment;
    const Rotation& rotation;
    bool shows_sky = true;  ///< false: black stands for the sky and the suns
};

/// What a ray sees, and how much of that is the layer.
struct SeenRay {
    formats::Rgb radiance;  ///< of layer and what is behind it [W m^-2 sr^-1]
    LayerSheet sheet;
};

/// Radiance along a ray to the ground or the sky, or to a surface of that radiance at ray.end where
/// `surface` is not null and the ground is not in front of it: the surface wins up to kGroundSlack
/// times the ground's distance, as floors often lie in the ground's plane.
SeenRay see_along(const LayerScene& scene, const LayerRay& ray,
                  const formats::Rgb* surface = nullptr);
/// Its radiance alone.
formats::Rgb see_through_layer(const LayerScene& scene, const LayerRay& ray,
                               const formats::Rgb* surface = nullptr);
inline constexpr double kGroundSlack = 1.001;

/// Distance at which a ray of unit direction meets the ground from above [m]; infinity if it does
/// not.
double ground_distance(const LayerLight& light, formats::Vec3 origin, formats::Vec3 direction);
/// The end of a view: a surface at the first distance, or the ground at the second. Infinity: none.
inline double opaque_distance(double surface, double ground) {
    return surface <= kGroundSlack * ground ? surface : ground;
}

}  // namespace opaline::runtime
