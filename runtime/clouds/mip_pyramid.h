#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace opaline::runtime {

/// What an image holds beyond its edges.
enum class MipBorder {
    repeat,  ///< the same again
    zero,    ///< nothing: bilinear between the outermost texels and 0
    clamp    ///< its outermost texels
};

/// One level of a pyramid, x fastest. Texel centres lie at ((column + 1/2) / columns, (row + 1/2) /
/// rows).
template <class T>
struct MipLevel {
    std::uint32_t columns = 0, rows = 0;
    std::vector<T> value;
};

/// An image and its means over ever larger squares, with the sizes that OpenGL asks for: max(1, n /
/// 2) down to 1 x 1. Every level has the same mean. T is float or formats::Rgb.
template <class T>
struct MipPyramid {
    std::vector<MipLevel<T>> level;  ///< [0] is the image
    MipBorder border = MipBorder::clamp;
};

namespace detail {

// Means over max(1, count / 2) parts of equal length of a line of `count` texels `stride` apart;
// `put(i, mean)`. Odd counts share texels between parts.
template <class T, class Put>
void halve_line(const T* line, std::size_t stride, std::uint32_t count, const Put& put) {
    const std::uint32_t half = std::max(1u, count / 2);
    const float length = static_cast<float>(count) / static_cast<float>(half);
    for (std::uint32_t i = 0; i < half; ++i) {
        const float begin = static_cast<float>(i) * length;
        const float end = std::min(begin + length, static_cast<float>(count));
        T sum{};
        for (auto k = static_cast<std::uint32_t>(begin); k < count; ++k) {
            const float at = static_cast<float>(k);
            const float part = std::min(at + 1, end) - std::max(at, begin);
            if (part <= 0) break;
            sum = sum + part / length * line[k * stride];
        }
        put(i, sum);
    }
}

// Of a number that an int holds; std::floor is a call on plain x86-64.
inline int floor_to_int(double x) {
    const int towards_zero = static_cast<int>(x);
    return towards_zero - (static_cast<double>(towards_zero) > x ? 1 : 0);
}

// Two texels of a line and their weights; texels beyond a zero border weigh nothing.
struct MipPlace {
    std::size_t first = 0, second = 0;
    float first_weight = 0, second_weight = 0;
};

inline MipPlace mip_place(double u, std::uint32_t count, MipBorder border) {
    const int last = static_cast<int>(count) - 1;
    // Clamp: farther texels equal the border, and the index stays small.
    const double at = std::clamp(u * (last + 1) - 0.5, -2.0, last + 2.0);
    int first = floor_to_int(at), second = first + 1;
    MipPlace place;
    place.second_weight = static_cast<float>(at - first);
    place.first_weight = 1 - place.second_weight;
    if (border == MipBorder::repeat) {
        if (first < 0) first = last;
        if (second > last) second = 0;
    } else if (border == MipBorder::zero) {
        if (first < 0 || first > last) place.first_weight = 0;
        if (second < 0 || second > last) place.second_weight = 0;
    }
    place.first = static_cast<std::size_t>(std::clamp(first, 0, last));
    place.second = static_cast<std::size_t>(std::clamp(second, 0, last));
    return place;
}

}  // namespace detail

/// Precondition: columns and rows are 1 or more, and `image` holds columns * rows values.
template <class T>
MipPyramid<T> make_pyramid(std::uint32_t columns, std::uint32_t rows, std::vector<T> image,
                           MipBorder border) {
    MipPyramid<T> pyramid;
    pyramid.border = border;
    pyramid.level.push_back({columns, rows, std::move(image)});
    while (pyramid.level.back().columns > 1 || pyramid.level.back().rows > 1) {
        const MipLevel<T>& fine = pyramid.level.back();
        MipLevel<T> coarse{std::max(1u, fine.columns / 2), std::max(1u, fine.rows / 2), {}};
        std::vector<T> narrow(std::size_t{coarse.columns} * fine.rows);
        for (std::uint32_t row = 0; row < fine.rows; ++row) {
            detail::halve_line(&fine.value[std::size_t{row} * fine.columns], 1, fine.columns,
                               [&](std::uint32_t i, T mean) {
                                   narrow[std::size_t{row} * coarse.columns + i] = mean;
                               });
        }
        coarse.value.resize(std::size_t{coarse.columns} * coarse.rows);
        for (std::uint32_t column = 0; column < coarse.columns; ++column) {
            detail::halve_line(&narrow[column], coarse.columns, fine.rows,
                               [&](std::uint32_t i, T mean) {
                                   coarse.value[std::size_t{i} * coarse.columns + column] = mean;
                               });
        }
        pyramid.level.push_back(std::move(coarse));
    }
    return pyramid;
}

namespace detail {

// u, v in [0, 1) where the border repeats.
template <class T>
T sample_within(const MipLevel<T>& level, MipBorder border, double u, double v) {
    const MipPlace x = mip_place(u, level.columns, border);
    const MipPlace y = mip_place(v, level.rows, border);
    const T* first = &level.value[y.first * level.columns];
    const T* second = &level.value[y.second * level.columns];
    return y.first_weight * (x.first_weight * first[x.first] + x.second_weight * first[x.second]) +
           y.second_weight *
               (x.first_weight * second[x.first] + x.second_weight * second[x.second]);
}

inline double within_period(double u, MipBorder border) {
    return border == MipBorder::repeat ? std::min(u - std::floor(u), 1.0) : u;
}

}  // namespace detail

/// Bilinear sample of one level; u, v in [0, 1] cover the image, finite.
template <class T>
T sample_level(const MipLevel<T>& level, MipBorder border, double u, double v) {
    return detail::sample_within(level, border, detail::within_period(u, border),
                                 detail::within_period(v, border));
}

/// Trilinear: `lod` counts levels, is clamped to those that exist, and may lie between two.
template <class T>
T sample_pyramid(const MipPyramid<T>& pyramid, double u, double v, float lod) {
    const float last = static_cast<float>(pyramid.level.size() - 1);
    const float at = lod > 0 ? std::min(lod, last) : 0.0f;
    const auto first = static_cast<std::size_t>(at);
    const double x = detail::within_period(u, pyramid.border);
    const double y = detail::within_period(v, pyramid.border);
    const T fine = detail::sample_within(pyramid.level[first], pyramid.border, x, y);
    const float share = at - static_cast<float>(first);
    if (share <= 0) return fine;
    const T coarse = detail::sample_within(pyramid.level[first + 1], pyramid.border, x, y);
    return (1 - share) * fine + share * coarse;
}

}  // namespace opaline::runtime
