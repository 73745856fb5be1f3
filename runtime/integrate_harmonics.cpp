#include "runtime/integrate_harmonics.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/cubemap.h"
#include "formats/opal/spherical_harmonics.h"
#include "runtime/parallel.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;

Rgb radiance_at(const Harmonics& harmonics, Vec3 w) {
    std::array<float, 9> value;
    formats::eval_spherical_harmonics(w, value);
    Rgb sum;
    for (std::size_t k = 0; k < value.size(); ++k) {
        sum = sum + value[k] * harmonics[k];
    }
    return sum;
}

}  // namespace

void integrate_harmonics(const Harmonics& harmonics, std::uint32_t n, const Rotation& rotation,
                         unsigned threads, std::span<double> integral) {
    // Gauss's two points a side, of as many parts of a texel as make parts of 1 / 16 at most.
    const std::uint32_t parts = std::max(32 / n, 1u), points = 2 * parts;
    const double width = 2.0 / n, part = width / parts, offset = 0.5 / std::sqrt(3.0);
    const auto point_at = [&](std::uint32_t texel, std::uint32_t i) {
        const std::uint32_t number = i / 2;
        return texel * width - 1 + (number + 0.5 + (i % 2 == 0 ? -offset : offset)) * part;
    };
    for_ranges(n, 1, threads, [&](std::uint32_t row, std::uint32_t) {
        for (std::uint32_t column = 0; column < n; ++column) {
            const double u = column * width - 1, v = row * width - 1;
            const double solid_angle = formats::rectangle_solid_angle(u, v, u + width, v + width);
            for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
                std::array<double, 3> sum{};
                double weight = 0;
                for (std::uint32_t i = 0; i < points * points; ++i) {
                    const Vec3 at = formats::cube_position(
                        {face, static_cast<float>(point_at(column, i % points)),
                         static_cast<float>(point_at(row, i / points))});
                    const float shrink = 1 / length(at);
                    const auto density = static_cast<double>(shrink * shrink * shrink);
                    const Rgb c = radiance_at(harmonics, rotation.light_from_world(shrink * at));
                    sum[0] += density * static_cast<double>(c.r);
                    sum[1] += density * static_cast<double>(c.g);
                    sum[2] += density * static_cast<double>(c.b);
                    weight += density;
                }
                double* texel = &integral[((std::size_t{face} * n + row) * n + column) * 3];
                for (std::size_t band = 0; band < 3; ++band) {
                    texel[band] += solid_angle / weight * sum[band];
                }
            }
        }
    });
}

formats::Environment sample_harmonics(const Harmonics& harmonics) {
    constexpr std::uint32_t kSize = 32;
    formats::Environment map;
    map.layout = formats::Environment::Layout::cube;
    map.width = kSize;
    map.height = formats::kCubeFaces * kSize;
    map.pixel.reserve(formats::cubemap_texels(kSize));
    for (std::uint32_t j = 0; j < formats::cubemap_texels(kSize); ++j) {
        const Rgb c = radiance_at(
            harmonics,
            formats::texel_direction(kSize, j / (kSize * kSize), j / kSize % kSize, j % kSize));
        map.pixel.push_back({std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)});
    }
    return map;
}

}  // namespace opaline::runtime
