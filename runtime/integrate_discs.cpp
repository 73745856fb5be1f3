#include "runtime/integrate_discs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "formats/opal/cubemap.h"
#include "formats/opal/vec3.h"

namespace opaline::runtime {
namespace {

using formats::DistantDisc;
using formats::Vec3;
using std::numbers::pi;

// A texel and its share of the flux of a small source.
struct TexelShare {
    std::uint32_t texel = 0;
    double share = 0;
};

// The four texels of 6 n n whose centres are around a direction, with bilinear shares that add up
// to 1; across the edges of faces too. Light of a small source projected like this is multiplied
// with the transport interpolated at the source, not with that of the one texel it falls into: it
// comes from where it is to second order in the texel's size, and moves evenly as it turns.
std::array<TexelShare, 4> nearest_texels(std::uint32_t n, formats::Vec3 direction) {
    const formats::CubePoint point = formats::cube_point(direction);
    // Of the grid of centres: whole numbers are centres.
    const double half = 0.5 * n;
    const double x = (static_cast<double>(point.u) + 1) * half - 0.5;
    const double y = (static_cast<double>(point.v) + 1) * half - 0.5;
    const double left = std::floor(x), up = std::floor(y);
    std::array<TexelShare, 4> shares;
    for (int i = 0; i < 4; ++i) {
        const double column = left + (i & 1), row = up + (i >> 1);
        // A centre beyond the face's edge lies in the neighbouring face.
        const formats::Vec3 centre =
            formats::cube_position({point.face, static_cast<float>((column + 0.5) / half - 1),
                                    static_cast<float>((row + 0.5) / half - 1)});
        shares[static_cast<std::size_t>(i)] = {
            formats::texel_index(n, centre), (1 - std::abs(x - column)) * (1 - std::abs(y - row))};
    }
    return shares;
}

// A frame whose third axis is the disc's direction.
struct DiscFrame {
    Vec3 across, along, axis;
};
DiscFrame frame_around(Vec3 axis) {
    const Vec3 helper = std::abs(axis.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    const Vec3 across = normalize(cross(helper, axis));
    return {across, cross(axis, across), axis};
}

// Sunflower: equal steps in height, the golden angle in azimuth.
void cover_small_disc(Vec3 axis, double radius, std::uint32_t n, std::span<double> cover) {
    constexpr std::uint32_t kPoints = 1024;
    const double golden_angle = pi * (3.0 - std::sqrt(5.0));
    const DiscFrame frame = frame_around(axis);
    const double half = std::sin(0.5 * radius);
    for (std::uint32_t i = 0; i < kPoints; ++i) {
        // 1 - cos theta grows evenly; with s = sin(theta / 2) nothing cancels.
        const double s = half * std::sqrt((i + 0.5) / kPoints);
        const double sine = 2.0 * s * std::sqrt(1.0 - s * s);
        const double phi = golden_angle * i;
        const Vec3 d = static_cast<float>(sine * std::cos(phi)) * frame.across +
                       static_cast<float>(sine * std::sin(phi)) * frame.along +
                       static_cast<float>(1.0 - 2.0 * s * s) * frame.axis;
        for (const TexelShare& part : nearest_texels(n, d)) {
            cover[part.texel] += part.share;
        }
    }
}

// Share of the texel [u, u + step] x [v, v + step] inside the disc.
double covered_share(Vec3 axis, float chord, std::uint32_t n, std::uint32_t face, std::uint32_t row,
                     std::uint32_t column) {
    constexpr std::uint32_t kSide = 32;
    std::uint32_t inside = 0;
    for (std::uint32_t y = row * kSide; y < (row + 1) * kSide; ++y) {
        for (std::uint32_t x = column * kSide; x < (column + 1) * kSide; ++x) {
            const Vec3 d = formats::texel_direction(n * kSide, face, y, x);
            inside += length(d - axis) <= chord ? 1 : 0;
        }
    }
    return static_cast<double>(inside) / (kSide * kSide);
}

void cover_large_disc(Vec3 axis, double radius, std::uint32_t n, std::span<double> cover) {
    // No point of a texel is further from its centre than this.
    const double reach = std::sqrt(2.0) / n, step = 2.0 / n;
    const auto chord = [](double angle) {
        return static_cast<float>(2.0 * std::sin(0.5 * std::clamp(angle, 0.0, pi)));
    };
    const float surely_inside = chord(radius - reach), surely_outside = chord(radius + reach);
    for (std::uint32_t row = 0; row < n; ++row) {
        for (std::uint32_t column = 0; column < n; ++column) {
            const double u = column * step - 1.0, v = row * step - 1.0;
            double solid_angle = 0;  // the same on all faces; most texels need none
            for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
                const float distance =
                    length(formats::texel_direction(n, face, row, column) - axis);
                if (distance > surely_outside) continue;
                const double share = distance < surely_inside
                                         ? 1.0
                                         : covered_share(axis, chord(radius), n, face, row, column);
                if (solid_angle == 0) {
                    solid_angle = formats::rectangle_solid_angle(u, v, u + step, v + step);
                }
                cover[(std::size_t{face} * n + row) * n + column] = share * solid_angle;
            }
        }
    }
}

}  // namespace

void integrate_discs(std::span<const DistantDisc> discs, std::uint32_t n, const Rotation& rotation,
                     std::span<double> integral) {
    std::vector<double> scratch(formats::cubemap_texels(n));
    integrate_discs(discs, n, rotation, scratch, integral);
}

void integrate_discs(std::span<const DistantDisc> discs, std::uint32_t n, const Rotation& rotation,
                     std::span<double> scratch, std::span<double> integral) {
    const std::span<double> cover = scratch.first(formats::cubemap_texels(n));
    for (const DistantDisc& disc : discs) {
        const Vec3 axis = normalize(rotation.world_from_light(disc.direction));
        const auto radius = static_cast<double>(disc.angular_radius);
        std::fill(cover.begin(), cover.end(), 0.0);
        if (radius < 2.0 / n) {
            cover_small_disc(axis, radius, n, cover);
        } else {
            cover_large_disc(axis, radius, n, cover);
        }
        double total = 0;
        for (const double c : cover) {
            total += c;
        }
        const double scale = formats::disc_solid_angle(disc.angular_radius) / total;
        for (std::size_t j = 0; j < cover.size(); ++j) {
            integral[3 * j] += scale * cover[j] * static_cast<double>(disc.radiance.r);
            integral[3 * j + 1] += scale * cover[j] * static_cast<double>(disc.radiance.g);
            integral[3 * j + 2] += scale * cover[j] * static_cast<double>(disc.radiance.b);
        }
    }
}

}  // namespace opaline::runtime
