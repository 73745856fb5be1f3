#include "bake/refine/interpolation_error.h"

#include <numbers>

namespace opaline::bake {

ErrorColumns square_beyond(const ProxyRows& rows, std::span<const double> solid_angle,
                           std::uint32_t row, std::span<const MixedRow> others) {
    constexpr double kPi = std::numbers::pi;
    constexpr double kOpen = 2 * kPi / 3;  // integral of the cosine's square over a hemisphere
    double suns = 0, sky = 0;
    for (std::size_t j = 0; j < rows.cells; ++j) {
        float value = rows.cell[row * rows.cells + j];
        for (const MixedRow& other : others) {
            value -= other.weight * static_cast<float>(rows.cell[other.row * rows.cells + j]);
        }
        const double difference = static_cast<double>(value) / 255;
        suns += solid_angle[j % solid_angle.size()] * difference * difference;
        sky += solid_angle[j % solid_angle.size()] * difference;
    }
    ErrorColumns square{};
    square[0] = 0.5 * (suns / kOpen + (sky / kPi) * (sky / kPi));
    for (std::size_t lamp = 0; lamp < rows.lamps; ++lamp) {
        double value = static_cast<double>(rows.lamps_of(row)[lamp]);
        for (const MixedRow& other : others) {
            value -= static_cast<double>(other.weight * rows.lamps_of(other.row)[lamp]);
        }
        square[1 + lamp] = value * value;
    }
    return square;
}

}  // namespace opaline::bake
