#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/volumes/sun_columns.h"

namespace opaline::runtime {

inline constexpr std::size_t kNoPoint = static_cast<std::size_t>(-1);

/// A brick, and those below it along each axis, or kNoBrick.
struct BrickSurroundings {
    std::uint32_t brick = 0;
    BrickBlock block;
    std::array<std::uint32_t, 3> below{};
};
BrickSurroundings brick_surroundings(const SunColumns& volume, std::uint32_t brick);

/// A point of suns, the nodes around it and the points next to it.
struct SunPoint {
    std::size_t column = 0;               ///< its place in SunColumns::column
    std::array<std::size_t, 6> next{};    ///< those along each axis, or kNoPoint
    formats::Vec3 world;                  ///< [m]
    std::array<std::uint32_t, 8> node{};  ///< or kNoNode
    std::array<float, 8> weight{};        ///< of nodes; the sum is 1, or 0 where none is
};
SunPoint make_sun_point(const SunColumns& volume, const BrickSurroundings& around,
                        const std::array<std::uint32_t, 3>& place);

/// What V^power at a point is to be multiplied by so that lines between points, which are above an
/// exponential between its ends, have its mean:
///
///     1 / (1 + max(0, s)),   s = sum over the points next to it of (e^(power (tau - tau_i)) - 1) /
///     12
///
/// with tau the optical depth that the volume itself has before a point, and e^x = 1 + x + x^2 / 2,
/// e^-x its inverse: of an even medium the mean is right to 4 % up to depths of 2.4 between points.
formats::Rgb find_lowering(const SunPoint& point, std::span<const float> column,
                           formats::Rgb sigma_t, float power);

}  // namespace opaline::runtime
