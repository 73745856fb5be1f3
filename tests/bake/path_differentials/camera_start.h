#pragma once

#include <glm/glm.hpp>

namespace opaline::bake {

/// A ray at the eye and its columns. Lens columns of a pinhole are 0.
struct CameraStart {
    glm::dvec3 P{0}, D{0};
    glm::dvec3 dD_dx{0}, dD_dy{0};  ///< of the two numbers within the pixel; dP = 0
    glm::dvec3 dP_du{0}, dP_dv{0}, dD_du{0}, dD_dv{0};  ///< of the two numbers on the lens
};

/// D = h / |h|, h = view + x right + y up. `right` and `up` are how far h moves while the pixel's
/// random number goes from 0 to 1: one pixel, where x counts pixels.
struct PinholeCamera {
    glm::dvec3 eye{0}, view{0, 0, -1}, right{1, 0, 0}, up{0, 1, 0};
};

/// (x, y): where on the image.
CameraStart start_at_pinhole(const PinholeCamera& camera, double x, double y);

/// A thin lens, its axes scaled by its radius; `view` reaches the plane in focus, where lens
/// columns vanish. (u, v) become a point of the lens by the concentric map.
struct LensCamera {
    PinholeCamera pinhole;
    glm::dvec3 lens_x{0}, lens_y{0};  ///< [m]
};

CameraStart start_at_lens(const LensCamera& camera, double x, double y, double u, double v);

}  // namespace opaline::bake
