#include "formats/image/chromaticities.h"

#include <algorithm>
#include <cmath>

namespace opaline::formats {
namespace {

using Vector = std::array<double, 3>;

constexpr Chromaticities kRec709{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
constexpr ColorMatrix kIdentity{1, 0, 0, 0, 1, 0, 0, 0, 1};
// XYZ to the responses of cones that Bradford's adaptation scales.
constexpr ColorMatrix kBradford{0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                0.0367, 0.0389, -0.0685, 1.0296};

ColorMatrix product(const ColorMatrix& a, const ColorMatrix& b) {
    ColorMatrix result{};
    for (std::size_t i = 0; i < 9; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            result[i] += a[i / 3 * 3 + k] * b[k * 3 + i % 3];
        }
    }
    return result;
}

Vector product(const ColorMatrix& a, const Vector& v) {
    Vector result{};
    for (std::size_t i = 0; i < 9; ++i) {
        result[i / 3] += a[i] * v[i % 3];
    }
    return result;
}

ColorMatrix diagonal(const Vector& v) {
    return {v[0], 0, 0, 0, v[1], 0, 0, 0, v[2]};
}

/// Cramer's rule; none if the determinant is 0 or not finite.
std::optional<ColorMatrix> inverse(const ColorMatrix& m) {
    const auto minor = [&](std::size_t row, std::size_t column) {
        const std::size_t a = (row + 1) % 3 * 3, b = (row + 2) % 3 * 3;
        const std::size_t c = (column + 1) % 3, d = (column + 2) % 3;
        return m[a + c] * m[b + d] - m[a + d] * m[b + c];
    };
    const double determinant = m[0] * minor(0, 0) + m[1] * minor(0, 1) + m[2] * minor(0, 2);
    if (!(std::abs(determinant) > 1e-6)) return std::nullopt;
    ColorMatrix result{};
    for (std::size_t i = 0; i < 9; ++i) {
        result[i] = minor(i % 3, i / 3) / determinant;
    }
    return result;
}

/// Linear RGB to XYZ and the white's XYZ, of luminance 1.
struct Space {
    ColorMatrix to_xyz{};
    Vector white{};
};

std::optional<Space> make_space(const Chromaticities& xy) {
    Space space;
    const double white_x = static_cast<double>(xy[6]), white_y = static_cast<double>(xy[7]);
    if (!(white_x > 0 && white_y > 1e-3 && white_x + white_y < 1)) return std::nullopt;
    space.white = {white_x / white_y, 1, (1 - white_x - white_y) / white_y};
    ColorMatrix primaries{};
    for (std::size_t band = 0; band < 3; ++band) {
        const double x = static_cast<double>(xy[2 * band]);
        const double y = static_cast<double>(xy[2 * band + 1]);
        if (!(std::abs(x) < 4 && std::abs(y) < 4)) return std::nullopt;
        primaries[band] = x;
        primaries[3 + band] = y;
        primaries[6 + band] = 1 - x - y;
    }
    // As much of each primary as makes their sum the white.
    const std::optional<ColorMatrix> solve = inverse(primaries);
    if (!solve) return std::nullopt;
    space.to_xyz = product(primaries, diagonal(product(*solve, space.white)));
    return space;
}

}  // namespace

std::optional<ColorMatrix> to_rec709(const Chromaticities& from) {
    if (std::equal(from.begin(), from.end(), kRec709.begin(),
                   [](float a, float b) { return std::abs(a - b) < 2e-3f; })) {
        return kIdentity;
    }
    const std::optional<Space> source = make_space(from), target = make_space(kRec709);
    if (!source || !target) return std::nullopt;
    const Vector old_cones = product(kBradford, source->white);
    const Vector new_cones = product(kBradford, target->white);
    Vector scale{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(old_cones[i] > 1e-3)) return std::nullopt;
        scale[i] = new_cones[i] / old_cones[i];
    }
    const std::optional<ColorMatrix> from_cones = inverse(kBradford);
    const std::optional<ColorMatrix> from_xyz = inverse(target->to_xyz);
    if (!from_cones || !from_xyz) return std::nullopt;
    const ColorMatrix adapted = product(*from_cones, product(diagonal(scale), kBradford));
    return product(*from_xyz, product(adapted, source->to_xyz));
}

void convert_colors(const ColorMatrix& matrix, std::vector<Rgb>& pixel) {
    if (matrix == kIdentity) return;
    for (Rgb& c : pixel) {
        if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b)) continue;
        const Vector given{static_cast<double>(c.r), static_cast<double>(c.g),
                           static_cast<double>(c.b)};
        const Vector v = product(matrix, given);
        c = {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
    }
}

}  // namespace opaline::formats
