#pragma once

#include <cmath>
#include <numbers>

#include "formats/opal/vec3.h"

namespace opaline::runtime {

/// A turn of the environment: where its axes point to in the world. Unit, perpendicular,
/// right-handed.
struct Rotation {
    formats::Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

/// About +Y, from +Z toward +X: a light at +Z moves to +X for 90 degrees.
inline Rotation rotation_about_y(float degrees) {
    const double radians = static_cast<double>(degrees) * std::numbers::pi / 180.0;
    const auto c = static_cast<float>(std::cos(radians)), s = static_cast<float>(std::sin(radians));
    return {{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
}

/// The environment's direction that is seen in the world direction `world`.
inline formats::Vec3 to_environment(const Rotation& rotation, formats::Vec3 world) {
    return {dot(rotation.x, world), dot(rotation.y, world), dot(rotation.z, world)};
}

}  // namespace opaline::runtime
