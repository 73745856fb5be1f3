#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "bake/physics/slab/column_model.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/solve_slab.h"
#include "formats/opal/vec3.h"
#include "runtime/clouds/slab_source.h"
#include "tests/stability/stability_row.h"

// Slabs and cloud layers.

namespace opaline::tests {
namespace {

using bake::ColumnModel;

// L_1^t as [Bouthors2006] prints it, over E p.
double textbook_once(double depth, double light, double view) {
    return light / (light - view) * (std::exp(-depth / light) - std::exp(-depth / view));
}

double textbook_reflected(double depth, double light, double view) {
    return light / (light + view) * (1 - std::exp(-(depth / light + depth / view)));
}

double textbook_twice(double depth, double light, double view) {
    const double x = depth / light + depth / view;
    return light / (light + view) * (1 - (1 + x) * std::exp(-x)) / 2;
}

double textbook_twice_through(double depth, double light, double view) {
    const double k = 1 / light - 1 / view, e = std::exp(-k * depth);
    return std::exp(-depth / view) / (2 * view) *
           (depth / view * (1 - e) / k + (1 - (1 + k * depth) * e) / k);
}

double textbook_spread(double a, double view) {
    const double e3 = ((1 - a) * std::exp(-a) - a * a * std::expint(-a)) / 2;
    return (1 - std::exp(-a / view)) / (1 - 2 * e3);
}

float textbook_source(float depth, float light, float view) {
    const float x_view = depth / view, x_light = depth / light;
    return light / (light - view) * (std::exp(-x_light) - std::exp(-x_view)) /
           (1 - std::exp(-x_view));
}

double textbook_angle(formats::Vec3 a, formats::Vec3 b) {
    return static_cast<double>(std::acos(formats::dot(a, b)));
}

formats::Vec3 at_angle(float angle) {
    return {std::sin(angle), std::cos(angle), 0};
}

bake::SlabFluxes conservative_slab(double depth, double cosine) {
    return bake::solve_slab({}, {.optical_depth = depth, .cosine = {cosine}}).front().total;
}

}  // namespace

StabilityField layer_rows() {
    const ColumnModel back{1, 1, 1, 1, 0, 1};
    const bake::SlabFluxes thick = conservative_slab(1e6, 1);
    const double zero = 0, x = 1e-9;
    const formats::Vec3 up{0, 1, 0}, down{0, -1, 0};
    const auto wide = [](float value) { return static_cast<double>(value); };
    return {
        "Slabs and cloud layers",
        {
            {"view along the light", "once, transmitted; depth 1, cosines .5", "1 / (μ_l − μ_v)",
             textbook_once(1, 0.5, 0.5), bake::transmitted_once(1, 0.5, 0.5), "2 * exp(-2)", 1e-15,
             1},
            {"view along the light", "the same, cosines .5, .5 + 1e-12", "1 / (μ_l − μ_v)",
             textbook_once(1, 0.5, 0.5 + 1e-12), bake::transmitted_once(1, 0.5, 0.5 + 1e-12),
             "once(1, 0.5, double(0.5 + 1e-12))", 1e-14, 1e-6},
            {"view along the light", "twice, transmitted; depth 1, cosines .5", "1 / (μ_l − μ_v)",
             textbook_twice_through(1, 0.5, 0.5), bake::transmitted_twice(1, 0.5, 0.5),
             "2 * exp(-2)", 1e-15, 1},
            {"view along the light", "the viewer's, floats; depth .5, cosines .3, .3 + 6e-8",
             "1 / (μ_l − μ_v)", wide(textbook_source(0.5f, 0.3f, std::nextafter(0.3f, 1.0f))),
             wide(runtime::transmitted_source(0.5f, 0.3f, std::nextafter(0.3f, 1.0f))),
             "once(0.5, single(0.3), single(0.30000001192092896 + 3e-8)) / -expm1(-0.5 / "
             "single(0.3))",
             1e-6, 1e-2},
            {"thin layers", "once, reflected; depth 1e-12, cosines 1, .5", "1 − e^−x",
             textbook_reflected(1e-12, 1, 0.5), bake::reflected_once(1e-12, 1, 0.5),
             "-expm1(-3 * 1e-12) / 1.5", 1e-14, 1e-6},
            {"thin layers", "twice, reflected; depth 5e-5, cosines 1", "1 − (1 + x) e^−x",
             textbook_twice(0.5e-4, 1, 1), bake::reflected_twice(0.5e-4, 1, 1),
             "(1 - (1 + mpf(1e-4)) * exp(-1e-4)) / 4", 1e-13, 1e-10},
            {"thin layers", "twice, reflected; depth 1e-9, cosines 1", "1 − (1 + x) e^−x",
             textbook_twice(x, 1, 1), bake::reflected_twice(x, 1, 1),
             "(1 - (1 + 2 * mpf(1e-9)) * exp(-2 * mpf(1e-9))) / 4", 1e-13, 1e-2},
            {"thin layers", "twice, transmitted; depth 1e-9, cosines 1, .5", "1 − (1 + x) e^−x",
             textbook_twice_through(x, 1, 0.5), bake::transmitted_twice(x, 1, 0.5),
             "twice(1e-9, 1, 0.5)", 1e-13, 1e-2},
            {"thin layers", "R_2 of a column that scatters both ways; depth 1e-9",
             "1 − (1 + 2x) e^−2x", 0.5 * (1 - (1 + 2 * x) * std::exp(-2 * x)),
             bake::column_orders({1, 1, 1, 1, 1, 1}, x).reflected[2],
             "(1 - (1 + 2 * mpf(1e-9)) * exp(-2 * mpf(1e-9))) / 2", 1e-13, 1e-2},
            {"thin layers", "T_2 of a column that scatters back; depth 1e-9", "2x − 1 + e^−2x",
             0.25 * (2 * x - 1 + std::exp(-2 * x)) * std::exp(-x),
             bake::column_orders(back, x).transmitted[2],
             "(2 * mpf(1e-9) - 1 + exp(-2 * mpf(1e-9))) * exp(-1e-9) / 4", 1e-12, 1e-2},
            {"thin layers", "R_1 of a column; depth 1e-17", "1 − e^−2x",
             0.5 * (1 - std::exp(-2e-17)), bake::column_orders(back, 1e-17).reflected[1],
             "-expm1(-2e-17) / 2", 1e-15, 1},
            {"thin layers", "what a path takes, floats; depth 1e-9", "1 − e^−x",
             wide(1 - std::exp(-1e-9f)), wide(runtime::taken_share(1e-9f)), "1e-9", 1e-6, 1},
            {"thin layers", "profile of higher orders; a 3e-15, cosine .7", "1 − 2 E_3(a)",
             textbook_spread(3e-15, 0.7), bake::spread_profile(3e-15, 0.7), "1 / 1.4", 1e-12, 1e-3},
            {"grazing view", "twice, reflected; depth 1, cosines .5, 0", "(1 + x) e^−x, x = H / 0",
             textbook_twice(1, 0.5, 0), bake::reflected_twice(1, 0.5, 0), "0.5", 1e-11, 1},
            {"light at 90°", "twice, reflected; depth 1, cosines 0, .5", "(1 + x) e^−x, x = H / 0",
             textbook_twice(1, 0, 0.5), bake::reflected_twice(1, 0, 0.5), "0", 1e-11, 1},
            {"light at 90°", "R_1, depth 1e6, cosine 1e-6", "E μ_l R_1 / (E μ_l), μ_l 0",
             zero / zero,
             bake::scatter_once({}, std::vector{1e6}, std::vector{1e-6}, 64)
                 .front()
                 .reflected.front(),
             "0.5", 2e-5, 1},
            {"difference of slant depths large", "once, transmitted; depth 1, cosines 1, 1e-3",
             "(e^d − 1) e^−X_v", 1 / (1 - 1e-3) * (std::exp(999.0) - 1) * std::exp(-1000.0),
             bake::transmitted_once(1, 1, 1e-3), "once(1, 1, 1e-3)", 1e-12, 1},
            {"huge depths", "T of even light, depth 1e6, albedo 1", "1 − R, R a float",
             wide(1 - static_cast<float>(thick.mean_reflectance)), thick.mean_transmittance,
             "4 / mpf(3) / (mpf(1e6) + 2 * mpf('0.710446089598763'))", 1e-3, 5e-3},
            {"angles near 0 and π", "1e-5 rad, floats", "acos(v · l)",
             textbook_angle(up, at_angle(1e-5f)),
             wide(runtime::scattering_angle(up, at_angle(1e-5f))), "single(1e-5)", 1e-6, 0.5},
            {"angles near 0 and π", "π − angle; 1e-4 rad, floats", "acos(v · l)",
             std::numbers::pi - textbook_angle(down, at_angle(1e-4f)),
             std::numbers::pi - wide(runtime::scattering_angle(down, at_angle(1e-4f))),
             "single(1e-4)", 1e-2, 0.5},
        }};
}

}  // namespace opaline::tests
