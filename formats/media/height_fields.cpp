#include "formats/media/height_fields.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>

#include "formats/media/lattice.h"

namespace opaline::formats {
namespace {

constexpr double kTau = 2 * std::numbers::pi;

// Height, of any origin and unit, at a place in [0, 1) x [0, 1).
using HeightAt = std::function<double(LatticePoint)>;

// The place of `p`, in tiles, on a lattice of squares.
LatticePoint on(LatticePoint p, const Lattice& lattice) {
    return {p.x * lattice.x, p.y * lattice.y};
}

LatticePoint times(double factor, LatticePoint p) {
    return {factor * p.x, factor * p.y};
}

// Noise as large as several cells or waves.
struct Patches {
    Lattice lattice;
    std::vector<Noise> octaves;

    Patches(const Lattice& cells, int size, int count, std::uint32_t seed) : lattice(cells) {
        lattice.x = std::max(1, cells.x / size);
        lattice.y = std::max(1, cells.y / size);
        octaves = make_octaves(lattice, count, seed);
    }
    double operator()(LatticePoint p) const { return eval_octaves(octaves, 0.5, on(p, lattice)); }
};

// Closed cells: domes with smaller and smaller domes on them, in patches.
HeightAt make_cells(const Lattice& cells, std::uint32_t seed) {
    return
        [=, bend_x = make_octaves(cells, 3, seed + 10), bend_y = make_octaves(cells, 3, seed + 20),
         large = make_domes(cells, seed + 30), middle = make_domes(finer(cells, 3), seed + 31),
         small = make_domes(finer(cells, 7), seed + 32), rough = make_octaves(cells, 4, seed + 40),
         patches = Patches(cells, 3, 2, seed + 50)](LatticePoint p) {
            const LatticePoint at = on(p, cells);
            const LatticePoint bent{at.x + 0.16 * eval_octaves(bend_x, 0.4, at),
                                    at.y + 0.16 * eval_octaves(bend_y, 0.4, at)};
            return 1.4 * eval_domes(large, bent) + 0.35 * eval_domes(middle, times(3, at)) +
                   0.2 * eval_domes(small, times(7, at)) + 0.15 * eval_octaves(rough, 0.6, at) +
                   0.15 * patches(p);
        };
}

// Billows: waves whose crests bend, fork and fade, with domes along them. Where they evolve, crests
// travel by a wavelength in a period, and bend where they come to a place that bends them.
HeightAt make_waves(const Lattice& cells, std::uint32_t seed) {
    Lattice still = cells;
    still.turn = 0;
    const double tilt = std::round(0.3 * cells.y);  // crests on the way across meet themselves
    return [=, far_bend = Patches(still, 4, 2, seed + 10),
            near_bend = make_octaves(still, 2, seed + 20), fading = Patches(cells, 3, 2, seed + 30),
            middle = make_domes(finer(cells, 2), seed + 40),
            small = make_domes(finer(cells, 5), seed + 41),
            patches = Patches(cells, 3, 5, seed + 50)](LatticePoint p) {
        const LatticePoint at = on(p, cells);
        const double phase =
            at.x + tilt * p.y + 0.8 * far_bend(p) + 0.12 * eval_octaves(near_bend, 0.5, at);
        const double wave = 0.5 + 0.5 * std::cos(kTau * phase - cells.turn);
        return (0.7 + 0.4 * fading(p)) * wave + 0.35 * eval_domes(middle, times(2, at)) +
               0.2 * eval_domes(small, times(5, at)) + 0.25 * patches(p);
    };
}

// From 0 to 1 and steep at 0: clouds have round edges.
double profile(double x) {
    return 1 - (1 - x) * std::sqrt(1 - x);
}

int count_of(double size, double scale) {
    return static_cast<int>(std::clamp(std::round(size / scale), 1.0, 65536.0));
}

// Heights at the centres of texels.
std::vector<float> heights_at(const HeightFieldShape& shape, const Lattice& cells) {
    const std::uint32_t side = shape.resolution;
    const HeightAt height = shape.type == HeightFieldShape::Type::cellular
                                ? make_cells(cells, shape.seed)
                                : make_waves(cells, shape.seed);
    std::vector<float> field;
    field.reserve(std::size_t{side} * side);
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            field.push_back(static_cast<float>(height({(x + 0.5) / side, (y + 0.5) / side})));
        }
    }
    return field;
}

// Lowers a frame so that `empty` texels are at 0 or below. Gives the highest one.
float sink(std::vector<float>& field, std::size_t empty) {
    std::vector<float> sorted = field;
    const auto sea = sorted.begin() + static_cast<std::ptrdiff_t>(empty == 0 ? 0 : empty - 1);
    std::nth_element(sorted.begin(), sea, sorted.end());
    const float low = *sea;
    const float high = *std::max_element(sea, sorted.end());
    for (float& value : field) {
        value -= low;
    }
    return high - low;
}

// Texels of a frame that are at 0.
std::size_t count_empty(const HeightFieldShape& shape) {
    const auto texels = static_cast<double>(std::size_t{shape.resolution} * shape.resolution);
    return static_cast<std::size_t>(std::llround((1 - shape.coverage) * texels));
}

}  // namespace

float find_highest(const HeightFieldShape& shape) {
    return count_empty(shape) == std::size_t{shape.resolution} * shape.resolution ? 0.0f : 1.0f;
}

std::vector<float> make_height_field(const HeightFieldShape& shape, std::array<double, 2> size) {
    const std::uint32_t side = shape.resolution;
    const std::size_t texels = std::size_t{side} * side;
    const std::size_t empty = count_empty(shape);
    if (empty == texels) return std::vector<float>(texels * shape.frames, 0.0f);
    constexpr int kTexels = 3;  // that show a dome or a ripple
    Lattice cells{count_of(size[0], shape.scale), count_of(size[1], shape.scale),
                  static_cast<int>(side / kTexels), shape.frames > 1};
    std::vector<float> all;
    all.reserve(texels * shape.frames);
    float highest = 0;
    for (std::uint32_t frame = 0; frame < shape.frames; ++frame) {
        cells.turn = kTau * frame / shape.frames;
        std::vector<float> field = heights_at(shape, cells);
        highest = std::max(highest, sink(field, empty));
        all.insert(all.end(), field.begin(), field.end());
    }
    for (float& value : all) {
        const double above = static_cast<double>(value) / static_cast<double>(highest);
        value = static_cast<float>(profile(std::clamp(above, 0.0, 1.0)));
    }
    return all;
}

}  // namespace opaline::formats
