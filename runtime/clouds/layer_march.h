#pragma once

#include <limits>

#include "formats/opal/vec3.h"
#include "runtime/clouds/layer_field.h"

namespace opaline::runtime {

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

}  // namespace opaline::runtime
