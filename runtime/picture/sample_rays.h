#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "formats/opal/vec3.h"
#include "runtime/picture/band.h"
#include "runtime/picture/camera.h"

namespace opaline::runtime {

/// A ray of a picture, from the near plane on.
struct PictureRay {
    formats::Vec3 origin, direction;  ///< direction: unit
    double begin = 0;                 ///< distance to the near plane [m]
    double cosine = 1;                ///< of the angle to the view axis
};

/// Through the point (x, y) of the picture [pixels].
inline PictureRay ray_through(const Camera& camera, const CameraFrame& frame, double x, double y) {
    PictureRay ray;
    ray.origin = camera.eye;
    ray.direction = view_ray(camera, frame, x, y);
    ray.cosine = -static_cast<double>(dot(ray.direction, frame.backward));
    ray.begin = ray.cosine > 0 ? static_cast<double>(camera.near_plane) / ray.cosine : 0;
    return ray;
}

/// Distance along the ray to what a sample sees, by Band::inverse_distance.
inline double distance_along(const PictureRay& ray, double inverse_distance) {
    return inverse_distance > 0 ? 1 / (inverse_distance * ray.cosine)
                                : std::numeric_limits<double>::infinity();
}

/// Calls f(sample, i, j) for the s x s samples of pixel (x, y), counted within the band.
template <class Function>
void for_samples(const Band& band, std::uint32_t s, std::uint32_t x, std::uint32_t y,
                 const Function& f) {
    for (std::uint32_t j = 0; j < s; ++j) {
        for (std::uint32_t i = 0; i < s; ++i) {
            f((std::size_t{y} * s + j) * band.columns + std::size_t{x} * s + i, i, j);
        }
    }
}

}  // namespace opaline::runtime
