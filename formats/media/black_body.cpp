#include "formats/media/black_body.h"

#include <algorithm>
#include <cstddef>

#include "formats/spectrum.h"

namespace opaline::formats {

Rgb black_body_radiance(double kelvin) {
    if (!(kelvin > 0)) return {};
    constexpr double kStep = 5;                   // [nm]
    constexpr double kRadiance = 1.191042972e20;  // 2 h c^2 [W m^-2 sr^-1 nm^-1] at 1 nm
    constexpr double kLumens = 683;               // per watt
    Xyz sum{};
    for (double nm = 360; nm <= 830; nm += kStep) {
        const double power = planck(nm, kelvin);
        const Xyz response = color_matching(nm);
        for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += kLumens * kRadiance * kStep * power * response[i];
        }
    }
    const std::array<double, 3> c = rec709_of_xyz(sum);
    const auto channel = [](double x) { return static_cast<float>(std::max(0.0, x)); };
    return {channel(c[0]), channel(c[1]), channel(c[2])};
}

}  // namespace opaline::formats
