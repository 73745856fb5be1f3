#include "formats/opal/haar.h"

#include <algorithm>
#include <vector>

#include "formats/opal/cubemap.h"

namespace opaline::formats {
namespace {

template <class T>
void forward(std::span<T> face, std::uint32_t n, std::span<T> scratch) {
    for (std::uint32_t size = n; size > 1; size /= 2) {
        const std::uint32_t half = size / 2;
        for (std::uint32_t row = 0; row < half; ++row) {
            const T* top = &face[std::size_t{2} * row * n];
            const T* bottom = top + n;
            T* out = &scratch[std::size_t{row} * size];
            T* out_low = out + std::size_t{half} * size;
            for (std::uint32_t column = 0; column < half; ++column) {
                const T a = top[2 * column], b = top[2 * column + 1];
                const T c = bottom[2 * column], d = bottom[2 * column + 1];
                const T ab = a + b, cd = c + d, a_b = a - b, c_d = c - d;
                out[column] = (ab + cd) / 2;
                out[column + half] = (a_b + c_d) / 2;
                out_low[column] = (ab - cd) / 2;
                out_low[column + half] = (a_b - c_d) / 2;
            }
        }
        for (std::uint32_t row = 0; row < size; ++row) {
            std::copy_n(&scratch[std::size_t{row} * size], size, &face[std::size_t{row} * n]);
        }
    }
}

template <class T>
void inverse(std::span<T> face, std::uint32_t n, std::span<T> scratch) {
    for (std::uint32_t size = 2; size <= n; size *= 2) {
        const std::uint32_t half = size / 2;
        for (std::uint32_t row = 0; row < half; ++row) {
            for (std::uint32_t column = 0; column < half; ++column) {
                const T ll = face[std::size_t{row} * n + column];
                const T lh = face[std::size_t{row} * n + column + half];
                const T hl = face[std::size_t{row + half} * n + column];
                const T hh = face[std::size_t{row + half} * n + column + half];
                T* top = &scratch[std::size_t{2} * row * size + 2 * column];
                T* bottom = top + size;
                top[0] = (ll + lh + hl + hh) / 2;
                top[1] = (ll - lh + hl - hh) / 2;
                bottom[0] = (ll + lh - hl - hh) / 2;
                bottom[1] = (ll - lh - hl + hh) / 2;
            }
        }
        for (std::uint32_t row = 0; row < size; ++row) {
            std::copy_n(&scratch[std::size_t{row} * size], size, &face[std::size_t{row} * n]);
        }
    }
}

template <class T>
void forward_cube(std::span<T> cube, std::uint32_t n) {
    std::vector<T> scratch(std::size_t{n} * n);
    for (std::uint32_t face = 0; face < kCubeFaces; ++face) {
        forward<T>(cube.subspan(std::size_t{face} * n * n, std::size_t{n} * n), n, scratch);
    }
}

}  // namespace

void haar_forward(std::span<float> face, std::uint32_t size, std::span<float> scratch) {
    forward(face, size, scratch);
}
void haar_inverse(std::span<float> face, std::uint32_t size, std::span<float> scratch) {
    inverse(face, size, scratch);
}
void haar_forward(std::span<double> face, std::uint32_t size, std::span<double> scratch) {
    forward(face, size, scratch);
}
void haar_inverse(std::span<double> face, std::uint32_t size, std::span<double> scratch) {
    inverse(face, size, scratch);
}
void haar_forward_cube(std::span<float> cube, std::uint32_t n) {
    forward_cube(cube, n);
}
void haar_forward_cube(std::span<double> cube, std::uint32_t n) {
    forward_cube(cube, n);
}

std::uint32_t haar_support(std::uint32_t n, std::uint32_t row, std::uint32_t column) {
    // A detail in the block that starts at `half` was made from squares of n / half texels.
    std::uint32_t half = 1;
    const std::uint32_t largest = std::max(row, column);
    while (half * 2 <= largest) {
        half *= 2;
    }
    return n / half;
}

}  // namespace opaline::formats
