#include "runtime/lookup_map.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "formats/opal/cubemap.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

void put(std::vector<float>& rgba, Rgb c) {
    rgba.insert(rgba.end(), {c.r, c.g, c.b, 1.0f});
}

void lay_out_lat_long(const Environment& map, LookupMap& out) {
    out.height = map.height;
    out.rgba.reserve(std::size_t{4} * (map.width + 2) * (map.height + 2));
    for (std::uint32_t row = 0; row < map.height + 2; ++row) {
        const Rgb* const from =
            &map.pixel[std::size_t{std::clamp(row, 1u, map.height) - 1} * map.width];
        put(out.rgba, from[map.width - 1]);
        for (std::uint32_t column = 0; column < map.width; ++column) {
            put(out.rgba, from[column]);
        }
        put(out.rgba, from[0]);
    }
}

// Beyond an edge: the texel of the neighbouring face that the direction falls into, as in
// formats::sample_map.
Rgb beyond_edge(const Environment& map, std::uint32_t face, float column, float row) {
    const auto size = static_cast<float>(map.width);
    return map.pixel[formats::texel_index(
        map.width, formats::cube_position({face, 2.0f * (column + 0.5f) / size - 1.0f,
                                           2.0f * (row + 0.5f) / size - 1.0f}))];
}

void lay_out_cube(const Environment& map, LookupMap& out) {
    const std::uint32_t n = map.width;
    out.height = n;
    out.rgba.reserve(std::size_t{4} * formats::kCubeFaces * (n + 2) * (n + 2));
    for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
        for (std::uint32_t y = 0; y < n + 2; ++y) {
            const float row = static_cast<float>(y) - 1;
            for (std::uint32_t x = 0; x < n + 2; ++x) {
                const bool inside = x > 0 && y > 0 && x <= n && y <= n;
                put(out.rgba, inside ? map.pixel[(std::size_t{face} * n + y - 1) * n + x - 1]
                                     : beyond_edge(map, face, static_cast<float>(x) - 1, row));
            }
        }
    }
}

// Where directions lie, in pixels of the bordered map from the centre of its first.
template <class L>
struct Places {
    typename L::Float column, row;
    typename L::Int first;  // pixel with which their face begins
};

// The same for a row of samples: the pixel to the left of and above each, and how far from it.
struct RowPlaces {
    alignas(32) std::array<std::int32_t, kMostSamples> pixel;
    alignas(32) std::array<float, kMostSamples> across, down;
};

template <class L>
OPALINE_ALWAYS_INLINE void find_lat_long(L lanes, const LookupMap& map, const typename L::Float& x,
                                         const typename L::Float& y, const typename L::Float& z,
                                         Places<L>& out) {
    using Float = typename L::Float;
    using Int = typename L::Int;
    const Float flat = x * x + z * z;
    Float root, turn, polar;
    reciprocal_root(lanes, flat, root);
    arc_tangent(lanes, z, x, turn);
    arc_tangent(lanes, flat * root, y, polar);
    Float u = map.u_offset + map.u_sign * (turn * (0.5f * std::numbers::inv_pi_v<float>));
    const Float whole = __builtin_convertvector(__builtin_convertvector(u, Int), Float);
    u = u - (whole > u ? whole - 1 : whole);
    const Float v = polar * std::numbers::inv_pi_v<float>;
    out.column = u * static_cast<float>(map.width) + 0.5f;
    out.row = map.rows_include_poles ? v * static_cast<float>(map.height - 1) + 1.0f
                                     : v * static_cast<float>(map.height) + 0.5f;
    const Float last = Float{} + static_cast<float>(map.height) + 0.5f;  // v rounds above 1
    out.row = out.row > last ? last : out.row;
    out.first = Int{};
}

// formats::cube_point of many directions.
template <class L>
OPALINE_ALWAYS_INLINE void find_cube(L, const LookupMap& map, const typename L::Float& x,
                                     const typename L::Float& y, const typename L::Float& z,
                                     Places<L>& out) {
    using Float = typename L::Float;
    using Int = typename L::Int;
    const Float ax = x < 0 ? -x : x, ay = y < 0 ? -y : y, az = z < 0 ? -z : z;
    const Int is_x = (ax >= ay) & (ax >= az), is_y = ~is_x & (ay >= az);
    const Float along = is_x ? x : is_y ? y : z, major = is_x ? ax : is_y ? ay : az;
    const Int front = along > 0;
    const Float minus_y = -y, minus_z = -z, minus_x = -x;
    const Float u = is_x ? (front ? minus_z : z) : is_y ? x : (front ? x : minus_x);
    const Float v = is_y ? (front ? z : minus_z) : minus_y;
    const Int zero = {};
    const Int face = (is_x ? zero : is_y ? zero + 2 : zero + 4) + (front ? zero : zero + 1);
    const auto size = static_cast<float>(map.width);
    out.column = (u / major * 0.5f + 0.5f) * size + 0.5f;
    out.row = (v / major * 0.5f + 0.5f) * size + 0.5f;
    const auto stride = static_cast<std::int32_t>((map.width + 2) * (map.width + 2));
    out.first = face * stride;
}

// Bilinear sample from the pixel at `p` and those to its right and below, times `weight`.
OPALINE_ALWAYS_INLINE void add_sample(const float* p, std::size_t stride, float across, float down,
                                      float weight, Float4& sum) {
    Float8 top, bottom;
    std::memcpy(&top, p, sizeof top);
    std::memcpy(&bottom, p + stride, sizeof bottom);
    const Float8 both = top + down * (bottom - top);
    const Float4 left = __builtin_shufflevector(both, both, 0, 1, 2, 3);
    const Float4 right = __builtin_shufflevector(both, both, 4, 5, 6, 7);
    sum += weight * (left + across * (right - left));
}

}  // namespace

LookupMap make_lookup_map(const Environment& map) {
    LookupMap out;
    out.layout = map.layout;
    out.width = map.width;
    out.u_offset = map.u_offset;
    out.u_sign = map.u_sign;
    out.rows_include_poles = map.rows_include_poles;
    if (map.pixel.empty()) return out;
    if (map.layout == Environment::Layout::cube) {
        lay_out_cube(map, out);
    } else {
        lay_out_lat_long(map, out);
    }
    return out;
}

void add_row(const LookupMap& map, Vec3 first, Vec3 step, std::span<const float> weight,
             std::span<Double4> sums) {
    RowPlaces places;
    run_wide([&](auto lanes) __attribute__((always_inline)) {
        using L = decltype(lanes);
        using Float = typename L::Float;
        using Int = typename L::Int;
        const bool cube = map.layout == Environment::Layout::cube;
        Float lane;
        number_lanes(lane);
        for (std::size_t i = 0; i < weight.size(); i += L::kCount) {
            const Float t = lane + static_cast<float>(i);
            const Float x = first.x + t * step.x, y = first.y + t * step.y,
                        z = first.z + t * step.z;
            Places<L> at;
            if (cube) {
                find_cube(lanes, map, x, y, z, at);
            } else {
                find_lat_long(lanes, map, x, y, z, at);
            }
            const Int column = __builtin_convertvector(at.column, Int);
            const Int row = __builtin_convertvector(at.row, Int);
            const Float across = at.column - __builtin_convertvector(column, Float);
            const Float down = at.row - __builtin_convertvector(row, Float);
            const Int pixel = at.first + row * static_cast<std::int32_t>(map.width + 2) + column;
            std::memcpy(&places.pixel[i], &pixel, sizeof pixel);
            std::memcpy(&places.across[i], &across, sizeof across);
            std::memcpy(&places.down[i], &down, sizeof down);
        }
    });
    run_wide([&](auto) __attribute__((always_inline)) {
        const float* const rgba = map.rgba.data();
        const std::size_t stride = std::size_t{4} * (map.width + 2);
        const std::size_t samples = weight.size() / sums.size();
        const auto take = [&](std::size_t i, Float4 & sum) __attribute__((always_inline)) {
            add_sample(rgba + 4 * std::ptrdiff_t{places.pixel[i]}, stride, places.across[i],
                       places.down[i], weight[i], sum);
        };
        for (std::size_t j = 0; j < sums.size(); ++j) {
            Float4 even = {}, odd = {};
            std::size_t i = j * samples;
            const std::size_t end = i + samples;
            for (; i + 2 <= end; i += 2) {
                take(i, even);
                take(i + 1, odd);
            }
            if (i < end) take(i, even);
            sums[j] += __builtin_convertvector(even + odd, Double4);
        }
    });
}

}  // namespace opaline::runtime
