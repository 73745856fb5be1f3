#pragma once

#include "formats/opal/environment.h"
#include "formats/opal/rgb.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/layer_march.h"
#include "runtime/clouds/layer_sheet.h"

namespace opaline::runtime {

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

/// The layer as a plane slab of the thickness that the ray sees (layer_march.h), whose light is
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
