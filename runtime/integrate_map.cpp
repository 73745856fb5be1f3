#include "runtime/integrate_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "runtime/map_geometry.h"
#include "runtime/parallel.h"
#include "runtime/reduce_map.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

// Samples per side of a texel at most. Full: about a thousand across a face, whatever the basis.
std::uint32_t most_samples(std::uint32_t n) {
    return std::clamp(1024 / n, 8u, 128u);
}
std::uint32_t most_moving_samples(std::uint32_t n) {
    return std::clamp(320 / n, 3u, 40u);
}

void add_texel(double* sum, double weight, const Rgb& value) {
    sum[0] += weight * static_cast<double>(value.r);
    sum[1] += weight * static_cast<double>(value.g);
    sum[2] += weight * static_cast<double>(value.b);
}

// Solid angles of one row of pixels on a face: between grid lines `line` and line + 1.
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

bool has_boxes(const Environment& map, std::uint32_t n) {
    return map.layout == Environment::Layout::cube && !map.pixel.empty() && map.width % n == 0;
}

std::vector<double> sum_boxes(const Environment& map, std::uint32_t n, unsigned threads) {
    std::vector<double> boxes(std::size_t{3} * formats::cubemap_texels(n));
    const std::uint32_t size = map.width, share = size / n;
    for_ranges(n, 1, threads, [&](std::uint32_t row, std::uint32_t) {
        GridRow grid(size);
        for (std::uint32_t y = row * share; y < (row + 1) * share; ++y) {
            grid.move_to(y);
            for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
                double* texel = &boxes[(std::size_t{face} * n + row) * n * 3];
                const Rgb* pixel = &map.pixel[(std::size_t{face} * size + y) * size];
                for (std::uint32_t x = 0; x < size; ++x) {
                    add_texel(texel + std::size_t{3} * (x / share), grid.solid_angle(x), pixel[x]);
                }
            }
        }
    });
    return boxes;
}

// A quarter turn moves texels onto texels.
void add_boxes(const std::vector<double>& boxes, std::uint32_t n, const Rotation& rotation,
               std::span<double> integral) {
    for (std::uint32_t j = 0; j < formats::cubemap_texels(n); ++j) {
        const Vec3 d = formats::texel_direction(n, j / (n * n), j / n % n, j % n);
        const std::uint32_t from = formats::texel_index(n, rotation.light_from_world(d));
        for (std::size_t band = 0; band < 3; ++band) {
            integral[std::size_t{3} * j + band] += boxes[std::size_t{3} * from + band];
        }
    }
}

// Relative solid angles of the points of a row, at most 1 / samples: with these no sum of finite
// radiance overflows.
void weigh_points(std::uint32_t size, std::uint32_t samples, std::uint32_t row,
                  std::span<float> weight) {
    const float step = 2.0f / static_cast<float>(size);
    const float v = (static_cast<float>(row) + 0.5f) * step - 1.0f;
    const float v_part = 1 + v * v, largest = 0.5f / static_cast<float>(samples);
    run_wide([&](auto lanes) __attribute__((always_inline)) {
        using L = decltype(lanes);
        typename L::Float lane, root;
        number_lanes(lane);
        for (std::size_t i = 0; i < weight.size(); i += L::kCount) {
            const typename L::Float u = (lane + (static_cast<float>(i) + 0.5f)) * step - 1.0f;
            reciprocal_root(lanes, v_part + u * u, root);
            const typename L::Float density = largest * (root * root * root);
            const std::size_t count = std::min(weight.size() - i, L::kCount);
            for (std::size_t k = 0; k < count; ++k) {
                weight[i + k] = density[k];
            }
        }
    });
}

void integrate_points(const PreparedMap& map, std::uint32_t samples, const Rotation& rotation,
                      unsigned threads, std::span<double> integral) {
    const std::uint32_t n = map.n, size = n * samples;
    const float step = 2.0f / static_cast<float>(size);
    for_ranges(n, 1, threads, [&](std::uint32_t row, std::uint32_t) {
        std::array<float, kMostSamples> storage;
        const std::span<float> weight = std::span(storage).first(size);
        std::array<Double4, formats::kCubeFaces * std::size_t{formats::kMaxCubemapSize}> sums;
        std::fill_n(sums.begin(), formats::kCubeFaces * n, Double4{});
        for (std::uint32_t y = row * samples; y < (row + 1) * samples; ++y) {
            weigh_points(size, samples, y, weight);
            const float v = (static_cast<float>(y) + 0.5f) * step - 1.0f;
            for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
                const Vec3 middle = rotation.light_from_world(formats::cube_position({face, 0, v}));
                const Vec3 across =
                    rotation.light_from_world(formats::cube_position({face, 1, v})) - middle;
                const float begin = 0.5f * step - 1.0f;
                add_row(map.lookup, middle + begin * across, step * across, weight,
                        std::span(sums).subspan(face * n, n));
            }
        }
        for (std::uint32_t column = 0; column < n; ++column) {
            const double solid_angle = map.solid_angle[std::size_t{row} * n + column];
            for (std::uint32_t face = 0; face < formats::kCubeFaces; ++face) {
                const Double4& sum = sums[face * n + column];
                const double scale = solid_angle / sum[3];
                double* texel = &integral[((std::size_t{face} * n + row) * n + column) * 3];
                for (std::size_t band = 0; band < 3; ++band) {
                    texel[band] += scale * sum[band];
                }
            }
        }
    });
}

Environment reduced(const Environment& map, double finest, unsigned threads) {
    const auto count = [finest](double angle) {
        return static_cast<std::uint32_t>(std::ceil(angle / finest));
    };
    return map.layout == Environment::Layout::cube
               ? reduce_cube(map, count(2.0), threads)
               : reduce_lat_long(map, count(2.0 * std::numbers::pi), count(std::numbers::pi),
                                 threads);
}

Environment shape_of(const Environment& map) {
    Environment shape;
    shape.layout = map.layout;
    shape.width = map.width;
    shape.height = map.height;
    shape.u_offset = map.u_offset;
    shape.u_sign = map.u_sign;
    shape.rows_include_poles = map.rows_include_poles;
    return shape;
}

}  // namespace

PreparedMap prepare_map(const Environment& map, std::uint32_t n, unsigned threads) {
    PreparedMap prepared;
    prepared.n = n;
    if (map.pixel.empty()) return prepared;
    if (has_boxes(map, n)) {
        prepared.boxes = sum_boxes(map, n, threads);
    }
    // Two samples per pixel at least: what is finer would fall through the grid.
    const double texel = 2.0 / n, most = most_samples(n), finest = 2.0 * texel / most;
    Environment fine = reduced(map, finest, threads);
    prepared.shape = shape_of(fine);
    prepared.solid_angle = formats::texel_solid_angles(n);
    const PixelSize pixel = pixel_size(fine);
    const auto samples = [texel, most, &pixel](double per_pixel) {
        return static_cast<std::uint32_t>(
            std::clamp(std::ceil(per_pixel * texel / pixel.smaller), 2.0, most));
    };
    if (pixel.larger < 0.5 * texel) {
        prepared.samples = samples(4.0);
        prepared.bright = take_bright_pixels(fine);
        prepared.sources = divide_sources(prepared.shape, prepared.bright);
    } else {
        // Pixels as large as texels: sixteen samples across make even a lone bright one exact to
        // 2 / (16.5 pi)^2 < 0.1 %, the worst ripple of a tent summed on a grid.
        prepared.samples = samples(16.0);
    }
    prepared.lookup = make_lookup_map(fine);
    return prepared;
}

void integrate_map(const PreparedMap& map, MapSampling sampling, const Rotation& rotation,
                   unsigned threads, std::span<double> integral) {
    if (map.lookup.rgba.empty()) return;
    if (!map.boxes.empty() && is_signed_permutation(rotation)) {
        add_boxes(map.boxes, map.n, rotation, integral);
        return;
    }
    if (sampling == MapSampling::full) {
        integrate_points(map, map.samples, rotation, threads, integral);
        project_small_sources(map.shape, map.bright, map.n, rotation, threads, integral);
    } else {
        integrate_points(map, std::min(map.samples, most_moving_samples(map.n)), rotation, threads,
                         integral);
        project_sources(map.sources, map.n, rotation, integral);
    }
}

void integrate_map(const Environment& map, std::uint32_t n, const Rotation& rotation,
                   unsigned threads, std::span<double> integral) {
    if (has_boxes(map, n) && is_signed_permutation(rotation)) {
        add_boxes(sum_boxes(map, n, threads), n, rotation, integral);
        return;
    }
    integrate_map(prepare_map(map, n, threads), MapSampling::full, rotation, threads, integral);
}

}  // namespace opaline::runtime
