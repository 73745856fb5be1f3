#include "bake/refine/interpolation_error.h"

#include <numbers>

namespace opaline::bake {

ErrorColumns square_beyond(const ProxyRows& rows, std::span<const double> solid_angle,
                           std::uint32_t row, std::span<const MixedRow> others) {
    constexpr double kPi = std::numbers::pi;
    constexpr double kOpen = 2 * kPi / 3;  // integral of the cosine's square over a hemisphere
    double suns = 0;
    std::array<double, 2> sky{};
    for (std::size_t j = 0; j < rows.cells; ++j) {
        const double area = solid_angle[j % solid_angle.size()];
        std::array<double, 2> difference{};
        for (std::size_t estimate = 0; estimate < 2; ++estimate) {
            float value = rows.cells_of(row, estimate)[j];
            for (const MixedRow& other : others) {
                value -= other.weight * static_cast<float>(rows.cells_of(other.row, estimate)[j]);
            }
            difference[estimate] = static_cast<double>(value) / 255;
            sky[estimate] += area * difference[estimate];
        }
        suns += area * difference[0] * difference[1];
    }
    ErrorColumns square{};
    square[0] = 0.5 * (suns / kOpen + (sky[0] / kPi) * (sky[1] / kPi));
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

}  // namespace opaline::bake
