#include "runtime/integrate_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "formats/opal/cubemap.h"
#include "runtime/map_geometry.h"
#include "runtime/parallel.h"
#include "runtime/project_small_sources.h"
#include "runtime/reduce_map.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

// Samples per side of a texel at most: about a thousand across a face, whatever the basis, which is
// what photographic maps can tell apart.
std::uint32_t max_samples(std::uint32_t n) {
    return std::clamp(1024 / n, 16u, 128u);
}

void add_texel(double* sum, double weight, const Rgb& value) {
    sum[0] += weight * static_cast<double>(value.r);
    sum[1] += weight * static_cast<double>(value.g);
    sum[2] += weight * static_cast<double>(value.b);
}

// Solid angles of one row of the n s x n s grid on a face: between grid lines `line` and line + 1.
class GridRow {
  public:
    explicit GridRow(std::uint32_t size) : size_(size), above_(size + 1u), below_(size + 1u) {}

    void move_to(std::uint32_t line) {
        fill(above_, line);
        fill(below_, line + 1);
    }
    double solid_angle(std::uint32_t column) const {
        return below_[column + 1] - below_[column] - above_[column + 1] + above_[column];
    }

  private:
    // The corner terms of formats::rectangle_solid_angle, each used by four cells.
    void fill(std::vector<double>& corner, std::uint32_t line) const {
        const double v = 2.0 * line / size_ - 1.0;
        for (std::uint32_t i = 0; i <= size_; ++i) {
            const double u = 2.0 * i / size_ - 1.0;
            corner[i] = std::atan2(u * v, std::sqrt(u * u + v * v + 1.0));
        }
    }
    std::uint32_t size_;
    std::vector<double> above_, below_;
};

bool is_signed_permutation(const Rotation& r) {
    const auto unit = [](float x) { return x == 0.0f || std::abs(x) == 1.0f; };
    return unit(r.x.x) && unit(r.x.y) && unit(r.x.z) && unit(r.y.x) && unit(r.y.y) && unit(r.y.z) &&
           unit(r.z.x) && unit(r.z.y) && unit(r.z.z);
}

// Calls value(face, row, column) on a grid of `samples` points a side in each texel and adds it up
// by exact solid angle.
template <class Value>
void integrate_grid(std::uint32_t n, std::uint32_t samples, unsigned threads,
                    std::span<double> integral, const Value& value) {
    const std::uint32_t size = n * samples;
    for_ranges(n, 1, threads, [&](std::uint32_t row, std::uint32_t) {
        GridRow grid(size);
        for (std::uint32_t y = row * samples; y < (row + 1) * samples; ++y) {
            grid.move_to(y);
            for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
                double* texel = &integral[(std::size_t{face} * n + row) * n * 3];
                for (std::uint32_t x = 0; x < size; ++x) {
                    add_texel(texel + std::size_t{3} * (x / samples), grid.solid_angle(x),
                              value(face, y, x));
                }
            }
        }
    });
}

void integrate_boxes(const Environment& map, std::uint32_t n, const Rotation& rotation,
                     unsigned threads, std::span<double> integral) {
    const std::uint32_t size = map.width;
    const bool turned = rotation.x.x != 1.0f || rotation.y.y != 1.0f;
    integrate_grid(n, size / n, threads, integral,
                   [&](std::uint32_t face, std::uint32_t row, std::uint32_t column) {
                       if (turned) {
                           return map.pixel[formats::texel_index(
                               size, rotation.light_from_world(
                                         formats::texel_direction(size, face, row, column)))];
                       }
                       return map.pixel[(std::size_t{face} * size + row) * size + column];
                   });
}

void integrate_bilinear(const Environment& map, std::uint32_t n, std::uint32_t samples,
                        const Rotation& rotation, unsigned threads, std::span<double> integral) {
    integrate_grid(n, samples, threads, integral,
                   [&](std::uint32_t face, std::uint32_t row, std::uint32_t column) {
                       return formats::sample_map(
                           map, rotation.light_from_world(
                                    formats::texel_direction(n * samples, face, row, column)));
                   });
}

Environment reduced(const Environment& map, double finest, unsigned threads) {
    constexpr double kPi = 3.14159265358979323846;
    const auto count = [finest](double angle) {
        return static_cast<std::uint32_t>(std::ceil(angle / finest));
    };
    return map.layout == Environment::Layout::cube
               ? reduce_cube(map, count(2.0), threads)
               : reduce_lat_long(map, count(2.0 * kPi), count(kPi), threads);
}

}  // namespace

void integrate_map(const Environment& map, std::uint32_t n, const Rotation& rotation,
                   unsigned threads, std::span<double> integral) {
    if (map.pixel.empty()) {
        return;
    }
    if (map.layout == Environment::Layout::cube && map.width % n == 0 &&
        is_signed_permutation(rotation)) {
        integrate_boxes(map, n, rotation, threads, integral);
        return;
    }
    // Two samples per pixel at least: what is finer would fall through the grid.
    const double texel = 2.0 / n, most = max_samples(n);
    Environment fine = reduced(map, 2.0 * texel / most, threads);
    const PixelSize pixel = pixel_size(fine);
    const auto samples = [texel, most, &pixel](double per_pixel) {
        return static_cast<std::uint32_t>(
            std::clamp(std::ceil(per_pixel * texel / pixel.smaller), 2.0, most));
    };
    if (pixel.larger < 0.5 * texel) {
        const std::vector<BrightPixel> bright = take_bright_pixels(fine);
        integrate_bilinear(fine, n, samples(4.0), rotation, threads, integral);
        project_small_sources(fine, bright, n, rotation, threads, integral);
    } else {
        // Pixels as large as texels: sixteen samples across make even a lone bright one exact to
        // 2 / (16.5 pi)^2 < 0.1 %, the worst ripple of a tent summed on a grid.
        integrate_bilinear(fine, n, samples(16.0), rotation, threads, integral);
    }
}

}  // namespace opaline::runtime
