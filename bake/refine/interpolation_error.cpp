#include "bake/refine/interpolation_error.h"

#include <algorithm>
#include <numbers>

namespace opaline::bake {
namespace {

constexpr double kPi = std::numbers::pi;

// Of distant light from one side: integrals over all directions.
struct SideSums {
    double suns = 0;              ///< of the square
    std::array<double, 2> sky{};  ///< of each estimate
    double square() const {
        constexpr double kOpen = 2 * kPi / 3;  // integral of the cosine's square over a hemisphere
        return 0.5 * (suns / kOpen + (sky[0] / kPi) * (sky[1] / kPi));
    }
};

SideSums sum_side(const ProxyRows& rows, std::span<const double> solid_angle, std::size_t side,
                  std::uint32_t row, std::span<const MixedRow> others) {
    SideSums sums;
    const std::size_t cells = rows.cells / rows.sides;
    for (std::size_t j = side * cells; j < (side + 1) * cells; ++j) {
        const double area = solid_angle[j % solid_angle.size()];
        std::array<double, 2> difference{};
        for (std::size_t estimate = 0; estimate < 2; ++estimate) {
            float value = rows.cells_of(row, estimate)[j];
            for (const MixedRow& other : others) {
                value -= other.weight * static_cast<float>(rows.cells_of(other.row, estimate)[j]);
            }
            difference[estimate] = static_cast<double>(value) / 255;
            sums.sky[estimate] += area * difference[estimate];
        }
        sums.suns += area * difference[0] * difference[1];
    }
    return sums;
}

}  // namespace

ErrorColumns square_beyond(const ProxyRows& rows, std::span<const double> solid_angle,
                           std::uint32_t row, std::span<const MixedRow> others) {
    ErrorColumns square{};
    for (std::size_t side = 0; side < rows.sides; ++side) {
        square[0] += sum_side(rows, solid_angle, side, row, others).square();
    }
    for (std::size_t lamp = 0; lamp < rows.lamps; ++lamp) {
        std::array<double, 2> difference{};
        for (std::size_t estimate = 0; estimate < 2; ++estimate) {
            difference[estimate] = static_cast<double>(rows.lamps_of(row, estimate)[lamp]);
            for (const MixedRow& other : others) {
                difference[estimate] -=
                    static_cast<double>(other.weight * rows.lamps_of(other.row, estimate)[lamp]);
            }
        }
        square[1 + lamp] = difference[0] * difference[1];
    }
    return square;
}

ErrorColumns square_where_shaded(const ProxyRows& rows, std::span<const double> solid_angle,
                                 std::uint32_t row) {
    constexpr double kShaded = 0.003;
    ErrorColumns square = square_beyond(rows, solid_angle, row, {});
    square[0] = 0;
    for (std::size_t side = 0; side < rows.sides; ++side) {
        const SideSums sums = sum_side(rows, solid_angle, side, row, {});
        const double shade = 1 - (sums.sky[0] + sums.sky[1]) / (2 * kPi);
        square[0] += std::clamp(shade / kShaded, 0.0, 1.0) * sums.square();
    }
    return square;
}

}  // namespace opaline::bake
