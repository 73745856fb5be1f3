#include "formats/media/height_fields.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace opaline::formats {
namespace {

constexpr double kTau = 2 * std::numbers::pi;

struct Point {
    double x = 0, y = 0;
};

// A lattice of unit squares that is repeated: `x` and `y` squares wide.
struct Period {
    int x = 1, y = 1;
    int finest = 1;  // with more squares than this on a side it is finer than texels can show
};

Period times(Period period, int factor) {
    return {period.x * factor, period.y * factor, period.finest};
}

bool is_too_fine(Period period) {
    return std::max(period.x, period.y) > period.finest;
}

// Into [0, count), from not far outside.
std::uint32_t wrap(int i, int count) {
    for (; i < 0; i += count) {
    }
    for (; i >= count; i -= count) {
    }
    return static_cast<std::uint32_t>(i);
}

// Bits without a pattern for a square of the lattice: the output permutation of PCG, of each number
// in turn.
std::uint32_t hash(int x, int y, Period period, std::uint32_t seed) {
    const auto mix = [](std::uint32_t bits) {
        bits = bits * 747796405u + 2891336453u;
        bits = ((bits >> ((bits >> 28) + 4)) ^ bits) * 277803737u;
        return (bits >> 22) ^ bits;
    };
    return mix(wrap(x, period.x) + mix(wrap(y, period.y) + mix(seed)));
}

// The low and the high half of the bits, each in [0, 1).
Point fractions(std::uint32_t bits) {
    return {(bits & 0xffffu) / 65536.0, (bits >> 16) / 65536.0};
}

double fade(double t) {
    return t * t * t * (t * (6 * t - 15) + 10);
}

// Gradient noise [Perlin1985], about -1 to 1 and 0 on average; features are one square wide.
double noise(Point p, Period period, std::uint32_t seed) {
    if (is_too_fine(period)) return 0;
    const double left = std::floor(p.x), top = std::floor(p.y);
    const double x = p.x - left, y = p.y - top;
    const auto corner = [&](int i, int j) {
        const Point slope =
            fractions(hash(static_cast<int>(left) + i, static_cast<int>(top) + j, period, seed));
        return (slope.x - 0.5) * (x - i) + (slope.y - 0.5) * (y - j);
    };
    return 4 * std::lerp(std::lerp(corner(0, 0), corner(1, 0), fade(x)),
                         std::lerp(corner(0, 1), corner(1, 1), fade(x)), fade(y));
}

// Octaves of it from squares as large as the lattice's, each half as large and `gain` as strong.
double fractal(Point p, Period period, int octaves, double gain, std::uint32_t seed) {
    double sum = 0, weight = 1;
    for (int i = 0, factor = 1; i < octaves; ++i, factor *= 2, weight *= gain) {
        sum += weight * noise({factor * p.x, factor * p.y}, times(period, factor),
                              seed + static_cast<std::uint32_t>(i));
    }
    return sum;
}

// Domes around one random point of each square, after [Worley1996]: 1 - (d/r)^2 of the nearest one,
// with a soft maximum (the norm of order 8), so that the valleys between domes are round. In
// [0, 1.3].
double domes(Point p, Period period, std::uint32_t seed) {
    if (is_too_fine(period)) return 0;
    // No point beyond the 3 x 3 squares around `p` is nearer than the radius.
    constexpr double kJitter = 0.85, kRadius = 1.5 - 0.5 * kJitter;
    const double left = std::floor(p.x), top = std::floor(p.y);
    double sum = 0;
    for (int j = -1; j <= 1; ++j) {
        for (int i = -1; i <= 1; ++i) {
            const Point at = fractions(
                hash(static_cast<int>(left) + i, static_cast<int>(top) + j, period, seed));
            const double dx = left + i + 0.5 + kJitter * (at.x - 0.5) - p.x;
            const double dy = top + j + 0.5 + kJitter * (at.y - 0.5) - p.y;
            const double dome = std::max(0.0, 1 - (dx * dx + dy * dy) / (kRadius * kRadius));
            const double square = dome * dome, fourth = square * square;
            sum += fourth * fourth;
        }
    }
    return std::sqrt(std::sqrt(std::sqrt(sum)));
}

// The place of `p`, in tiles, on a lattice of squares.
Point on(Point p, Period period) {
    return {p.x * period.x, p.y * period.y};
}

// Noise as large as several cells or waves.
double patches(Point p, Period cells, int size, int octaves, std::uint32_t seed) {
    const Period period{std::max(1, cells.x / size), std::max(1, cells.y / size), cells.finest};
    return fractal(on(p, period), period, octaves, 0.5, seed);
}

// Closed cells: domes with smaller and smaller domes on them, in patches.
double cellular(Point p, Period cells, std::uint32_t seed) {
    const Point at = on(p, cells);
    const Point bent{at.x + 0.16 * fractal(at, cells, 3, 0.4, seed + 10),
                     at.y + 0.16 * fractal(at, cells, 3, 0.4, seed + 20)};
    return 1.4 * domes(bent, cells, seed + 30) +
           0.35 * domes({3 * at.x, 3 * at.y}, times(cells, 3), seed + 31) +
           0.2 * domes({7 * at.x, 7 * at.y}, times(cells, 7), seed + 32) +
           0.15 * fractal(at, cells, 4, 0.6, seed + 40) + 0.15 * patches(p, cells, 3, 2, seed + 50);
}

// Billows: waves whose crests bend, fork and fade, with domes along them.
double waves(Point p, Period cells, std::uint32_t seed) {
    const Point at = on(p, cells);
    const double tilt =
        std::round(0.3 * cells.y);  // crests on the way across: they meet themselves
    const double phase = at.x + tilt * p.y + 0.8 * patches(p, cells, 4, 2, seed + 10) +
                         0.12 * fractal(at, cells, 2, 0.5, seed + 20);
    const double wave = 0.5 + 0.5 * std::cos(kTau * phase);
    const double strength = 0.7 + 0.4 * patches(p, cells, 3, 2, seed + 30);
    return strength * wave + 0.35 * domes({2 * at.x, 2 * at.y}, times(cells, 2), seed + 40) +
           0.2 * domes({5 * at.x, 5 * at.y}, times(cells, 5), seed + 41) +
           0.25 * patches(p, cells, 3, 5, seed + 50);
}

// From 0 to 1 and steep at 0: clouds have round edges.
double profile(double x) {
    return 1 - (1 - x) * std::sqrt(1 - x);
}

int count_of(double size, double scale) {
    return static_cast<int>(std::clamp(std::round(size / scale), 1.0, 65536.0));
}

}  // namespace

std::vector<float> make_height_field(const HeightFieldShape& shape, std::array<double, 2> size) {
    const std::uint32_t side = shape.resolution;
    const std::size_t texels = std::size_t{side} * side;
    const auto empty =
        static_cast<std::size_t>(std::llround((1 - shape.coverage) * static_cast<double>(texels)));
    std::vector<float> field(texels, 0.0f);
    if (empty == texels) {
        return field;
    }
    constexpr int kTexels = 3;  // that show a dome or a ripple
    const Period cells{count_of(size[0], shape.scale), count_of(size[1], shape.scale),
                       static_cast<int>(side / kTexels)};
    const auto height = shape.type == HeightFieldShape::Type::cellular ? cellular : waves;
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            field[std::size_t{y} * side + x] =
                static_cast<float>(height({(x + 0.5) / side, (y + 0.5) / side}, cells, shape.seed));
        }
    }
    std::vector<float> sorted = field;
    const auto sea = sorted.begin() + static_cast<std::ptrdiff_t>(empty == 0 ? 0 : empty - 1);
    std::nth_element(sorted.begin(), sea, sorted.end());
    const double low = static_cast<double>(*sea);
    const double high = static_cast<double>(*std::max_element(sea, sorted.end()));
    for (float& value : field) {
        const double above = (static_cast<double>(value) - low) / (high - low);
        value = static_cast<float>(profile(std::clamp(above, 0.0, 1.0)));
    }
    return field;
}

}  // namespace opaline::formats
