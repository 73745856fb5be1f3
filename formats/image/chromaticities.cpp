#include "formats/image/chromaticities.h"

#include <algorithm>
#include <cmath>

namespace opaline::formats {
namespace {

constexpr Chromaticities kRec709{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};

// XYZ to the responses of cones that Bradford's adaptation scales.
const glm::dmat3 kBradford{{0.8951, -0.7502, 0.0389},  //
                           {0.2664, 1.7135, -0.0685},
                           {-0.1614, 0.0367, 1.0296}};

/// The columns of a matrix times the numbers of a vector.
glm::dmat3 scaled(glm::dmat3 matrix, glm::dvec3 by) {
    for (int i = 0; i < 3; ++i) {
        matrix[i] *= by[i];
    }
    return matrix;
}

/// Linear RGB to XYZ and the white's XYZ, of luminance 1.
struct Space {
    glm::dmat3 to_xyz;
    glm::dvec3 white;
};

std::optional<Space> make_space(const Chromaticities& xy) {
    const double white_x{xy[6]}, white_y{xy[7]};
    if (!(white_x > 0 && white_y > 1e-3 && white_x + white_y < 1)) return std::nullopt;
    const glm::dvec3 white(white_x / white_y, 1, (1 - white_x - white_y) / white_y);
    glm::dmat3 primaries;
    for (std::size_t band = 0; band < 3; ++band) {
        const double x{xy[2 * band]}, y{xy[2 * band + 1]};
        if (!(std::abs(x) < 4 && std::abs(y) < 4)) return std::nullopt;
        primaries[static_cast<int>(band)] = {x, y, 1 - x - y};
    }
    if (!(std::abs(glm::determinant(primaries)) > 1e-6)) return std::nullopt;
    // As much of each primary as makes their sum the white.
    return Space{scaled(primaries, glm::inverse(primaries) * white), white};
}

}  // namespace

std::optional<ColorMatrix> to_rec709(const Chromaticities& from) {
    if (std::equal(from.begin(), from.end(), kRec709.begin(),
                   [](float a, float b) { return std::abs(a - b) < 2e-3f; })) {
        return ColorMatrix(1);
    }
    const std::optional<Space> source = make_space(from), target = make_space(kRec709);
    if (!source || !target) return std::nullopt;
    const glm::dvec3 old_cones = kBradford * source->white;
    if (!glm::all(glm::greaterThan(old_cones, glm::dvec3(1e-3)))) return std::nullopt;
    const glm::dvec3 scale = kBradford * target->white / old_cones;
    const glm::dmat3 adapted = scaled(glm::inverse(kBradford), scale) * kBradford;
    return glm::inverse(target->to_xyz) * (adapted * source->to_xyz);
}

void convert_colors(const ColorMatrix& matrix, std::vector<Rgb>& pixel) {
    if (matrix == ColorMatrix(1)) return;
    for (Rgb& c : pixel) {
        if (!std::isfinite(c.r) || !std::isfinite(c.g) || !std::isfinite(c.b)) continue;
        const glm::vec3 v(matrix * glm::dvec3(c.r, c.g, c.b));
        c = {v.x, v.y, v.z};
    }
}

}  // namespace opaline::formats
