#pragma once

#include <array>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/clouds/layer_field.h"
#include "runtime/clouds/layer_light.h"

namespace opaline::runtime {

// Light of irradiance E, on a plane facing it, that a slab scatters once toward an eye: radiance E
// p(cos) [1/sr] times these factors (bake/physics/slab/README.md, "Once and twice"). They are
// divided by 1
// - exp(-depth / view), the share of the view that the slab takes, so that they are those of a
// source: bounded by 1, finite for every depth in [0, inf] and for cosines in [1e-3, 1].

/// mu_l / (mu_l + mu_v) (1 - e^-(X_l + X_v)) / (1 - e^-X_v), on the side of the light.
float reflected_source(float depth, float light, float view);

/// X_v e^-min(X_l, X_v) phi(|X_l - X_v|) / (1 - e^-X_v), phi(d) = (1 - e^-d) / d; on the other.
float transmitted_source(float depth, float light, float view);

/// 1 - e^-depth, the share that a path of that depth takes; depth in [0, inf].
float taken_share(float depth);

/// How a slab is looked at.
struct SlabView {
    formats::Vec3 direction;       ///< unit, from the eye, world
    std::array<float, 3> depth{};  ///< kappa_S H, by band
    double x = 0, z = 0;           ///< of what is seen [m]
    LayerSlope slope;              ///< of the top, for the reflected side
};

/// Radiance of a slab's own light over 1 - exp(-depth / mu_v) [W m^-2 sr^-1]: that of an opaque
/// source that it is taken for. `transmitted`: from below, else from above. Suns: single scattering
/// as it is, more from their tables; even light of the sky and of the ground.
formats::Rgb slab_source(const LayerLight& light, const SlabView& view, bool transmitted);

/// Angle [rad] by which light turns from a sun to an eye, both unit, exact near 0 and pi: `to_sun`
/// from the scatterer, `from_eye` along the view.
float scattering_angle(formats::Vec3 to_sun, formats::Vec3 from_eye);

}  // namespace opaline::runtime
