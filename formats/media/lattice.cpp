#include "formats/media/lattice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace opaline::formats {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
// No dome beyond the 3 x 3 squares around a point is nearer than the radius.
constexpr double kJitter = 0.85, kRadius = 1.5 - 0.5 * kJitter;

// Into [0, count), from not far outside.
std::size_t wrap(int i, int count) {
    for (; i < 0; i += count) {
    }
    for (; i >= count; i -= count) {
    }
    return static_cast<std::size_t>(i);
}

// std::floor is a call on processors that are taken for old ones.
int floor_of(double x) {
    const int whole = static_cast<int>(x);
    return static_cast<double>(whole) > x ? whole - 1 : whole;
}

// Bits without a pattern for a square of the lattice: the output permutation of PCG, of each number
// in turn.
std::uint32_t hash(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
    const auto mix = [](std::uint32_t bits) {
        bits = bits * 747796405u + 2891336453u;
        bits = ((bits >> ((bits >> 28) + 4)) ^ bits) * 277803737u;
        return (bits >> 22) ^ bits;
    };
    return mix(x + mix(y + mix(seed)));
}

// The low and the high half of the bits, each in [0, 1).
LatticePoint fractions(std::uint32_t bits) {
    return {(bits & 0xffffu) / 65536.0, (bits >> 16) / 65536.0};
}

double fade(double t) {
    return t * t * t * (t * (6 * t - 15) + 10);
}

// `make(x, y)` of every square.
template <class T, class Make>
std::vector<T> for_squares(const Lattice& lattice, Make make) {
    std::vector<T> all;
    if (lattice.is_too_fine()) return all;
    for (int y = 0; y < lattice.y; ++y) {
        for (int x = 0; x < lattice.x; ++x) {
            all.push_back(make(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)));
        }
    }
    return all;
}

}  // namespace

Lattice finer(Lattice lattice, int factor) {
    lattice.x *= factor;
    lattice.y *= factor;
    return lattice;
}

Noise make_noise(const Lattice& lattice, std::uint32_t seed) {
    const double cosine = std::cos(lattice.turn), sine = std::sin(lattice.turn);
    return {lattice, for_squares<LatticePoint>(lattice, [&](std::uint32_t x, std::uint32_t y) {
                const std::uint32_t bits = hash(x, y, seed);
                const LatticePoint slope = fractions(bits);
                const double along = slope.x - 0.5, across = slope.y - 0.5;
                const double s = (bits & 1u) != 0 ? sine : -sine;
                return LatticePoint{cosine * along - s * across, s * along + cosine * across};
            })};
}

double eval_noise(const Noise& noise, LatticePoint p) {
    if (noise.slope.empty()) return 0;
    const int left = floor_of(p.x), top = floor_of(p.y);
    const double x = p.x - left, y = p.y - top;
    const std::size_t columns[] = {wrap(left, noise.lattice.x), wrap(left + 1, noise.lattice.x)};
    const auto row = [&](int j) {
        const LatticePoint* const slope =
            &noise
                 .slope[wrap(top + j, noise.lattice.y) * static_cast<std::size_t>(noise.lattice.x)];
        const LatticePoint &near = slope[columns[0]], &far = slope[columns[1]];
        return std::lerp(near.x * x + near.y * (y - j), far.x * (x - 1) + far.y * (y - j), fade(x));
    };
    return 4 * std::lerp(row(0), row(1), fade(y));
}

std::vector<Noise> make_octaves(const Lattice& lattice, int octaves, std::uint32_t seed) {
    std::vector<Noise> all;
    all.reserve(static_cast<std::size_t>(std::max(0, octaves)));
    for (int i = 0; i < octaves; ++i) {
        all.push_back(make_noise(finer(lattice, 1 << i), seed + static_cast<std::uint32_t>(i)));
    }
    return all;
}

double eval_octaves(const std::vector<Noise>& octaves, double gain, LatticePoint p) {
    double sum = 0, weight = 1, factor = 1;
    for (const Noise& noise : octaves) {
        sum += weight * eval_noise(noise, {factor * p.x, factor * p.y});
        factor *= 2;
        weight *= gain;
    }
    return sum;
}

Domes make_domes(const Lattice& lattice, std::uint32_t seed) {
    constexpr double kBreath = 0.25;
    constexpr std::uint32_t kPhases = 1000;  // from the seed of places to that of phases
    return {lattice, for_squares<Domes::Dome>(lattice, [&](std::uint32_t x, std::uint32_t y) {
                const LatticePoint at = fractions(hash(x, y, seed));
                Domes::Dome dome{at.x - 0.5, at.y - 0.5, 1};
                if (lattice.evolves) {
                    const double radius = 0.5 - std::max(std::abs(dome.x), std::abs(dome.y));
                    const LatticePoint phase = fractions(hash(x, y, seed + kPhases));
                    const double angle =
                        (phase.x < 0.5 ? lattice.turn : -lattice.turn) + 2 * kTurn * phase.x;
                    dome.x += radius * std::cos(angle);
                    dome.y += radius * std::sin(angle);
                    dome.height += kBreath * std::sin(lattice.turn + kTurn * phase.y);
                }
                return Domes::Dome{kJitter * dome.x, kJitter * dome.y, dome.height};
            })};
}

double eval_domes(const Domes& domes, LatticePoint p) {
    if (domes.dome.empty()) return 0;
    constexpr double kSharpness = 1 / (kRadius * kRadius);
    const int left = floor_of(p.x), top = floor_of(p.y);
    const std::size_t columns[] = {wrap(left - 1, domes.lattice.x), wrap(left, domes.lattice.x),
                                   wrap(left + 1, domes.lattice.x)};
    double sum = 0;
    for (int j = -1; j <= 1; ++j) {
        const Domes::Dome* const row =
            &domes.dome[wrap(top + j, domes.lattice.y) * static_cast<std::size_t>(domes.lattice.x)];
        for (int i = -1; i <= 1; ++i) {
            const Domes::Dome& at = row[columns[i + 1]];
            const double dx = left + i + 0.5 + at.x - p.x, dy = top + j + 0.5 + at.y - p.y;
            const double dome = at.height * std::max(0.0, 1 - kSharpness * (dx * dx + dy * dy));
            const double square = dome * dome, fourth = square * square;
            sum += fourth * fourth;
        }
    }
    return std::sqrt(std::sqrt(std::sqrt(sum)));
}

}  // namespace opaline::formats
