#pragma once

#include <cstdint>
#include <span>

namespace opaline::formats {

/// Orthonormal non-standard 2-D Haar transform, per cube face.
///
/// On each 2x2 block (a b; c d), row down, column right, of the current low-pass quarter:
///     LL = (a+b+c+d)/2 to the top-left quarter,      LH = (a-b+c-d)/2 to the top-right,
///     HL = (a+b-c-d)/2 to the bottom-left,           HH = (a-b-c+d)/2 to the bottom-right.
/// Coefficient index = (face * n + row) * n + column in that layout; index face * n * n is the
/// face average times n. Orthonormal: dot products of two maps equal those of their transforms.

/// In place on `size` x `size` values; size a power of two; `scratch` holds at least size * size.
void haar_forward(std::span<float> face, std::uint32_t size, std::span<float> scratch);
void haar_inverse(std::span<float> face, std::uint32_t size, std::span<float> scratch);
void haar_forward(std::span<double> face, std::uint32_t size, std::span<double> scratch);
void haar_inverse(std::span<double> face, std::uint32_t size, std::span<double> scratch);

/// Whole cube map, 6 n n values, face by face.
void haar_forward_cube(std::span<float> cube, std::uint32_t n);
void haar_forward_cube(std::span<double> cube, std::uint32_t n);

/// Side of a coefficient's support, in texels: n for the average and the coarsest details, 2 for
/// the finest. `row` and `column` within the face.
std::uint32_t haar_support(std::uint32_t n, std::uint32_t row, std::uint32_t column);

}  // namespace opaline::formats
