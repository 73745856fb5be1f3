#include "bake/effects/multiple/walks/limit_views.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace opaline::bake {
namespace {

// In proportion to what a row makes of light that is even over texels: the first coefficient of
// each face is its mean.
float under_even_light(std::span<const float> row, std::uint32_t stride, std::uint32_t band) {
    const std::size_t face = row.size() / stride / 6;
    float sum = 0;
    for (std::size_t f = 0; f < 6; ++f) {
        sum += row[f * face * stride + band];
    }
    return sum;
}

}  // namespace

float limit_views(std::span<const float> row, std::span<const float> rows, std::uint32_t stride,
                  glm::vec3 normal, double mean, double eta) {
    const double steepest = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
    const auto along = static_cast<float>(std::max(1 - mean, mean - steepest));
    const auto across = static_cast<float>(std::sqrt(1 - steepest * steepest));
    const std::uint32_t bands = stride == 1 ? 1 : 3;
    float factor = 1;
    for (std::uint32_t band = 0; band < bands; ++band) {
        glm::vec3 view(0);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
            const auto own = rows.subspan(axis * row.size(), row.size());
            view[static_cast<int>(axis)] = under_even_light(own, stride, band);
        }
        const float straight = glm::dot(view, normal);
        const float most =
            along * std::abs(straight) + across * glm::length(view - straight * normal);
        const float even = std::max(0.0f, under_even_light(row, stride, band));
        if (most > even) {
            factor = std::min(factor, even / most);
        }
    }
    return factor;
}

}  // namespace opaline::bake
