#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

#include "bake/physics/path_integral/grid_medium.h"
#include "bake/physics/path_integral/quasi_path.h"
#include "bake/physics/path_integral/turn.h"
#include "bake/physics/path_integral/zonal_table.h"
#include "bake/physics/phase.h"
#include "bake/physics/phase_series.h"
#include "tests/stability/naive_forms.h"
#include "tests/stability/stability_row.h"

// Path integration through volumes.

namespace opaline::tests {
namespace {

using glm::dvec3;
using std::numbers::pi;

double textbook_moment(double lambda, double ell) {
    return (std::exp(ell * lambda) - 1) / (std::exp(ell) - 1);
}

// (8) of [Premoze2003]: as far as the next step in scattering depth reaches.
double textbook_length(double scattering, double ell) {
    return ell / scattering;
}

double textbook_exit(const bake::VolumeBox& box, dvec3 x, dvec3 direction) {
    double nearest = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double low = (box.low[axis] - x[axis]) / direction[axis];
        const double high = (box.high[axis] - x[axis]) / direction[axis];
        const double face = std::max(low, high);
        nearest = nearest < face ? nearest : face;
    }
    return nearest;
}

double angle_between(dvec3 a, dvec3 b) {
    return bake::Turns(a, b)[0].angle;
}

dvec3 turned(double angle) {
    return {std::sin(angle), 0, std::cos(angle)};
}

const bake::VolumeBox kUnitBox{dvec3(0), dvec3(1)};

bake::PathEnd march(const bake::QuasiPath& path, bake::Coefficients medium) {
    return bake::march_quasi_path(
        path, [medium](dvec3) { return medium; }, {kUnitBox, 0.125},
        [](const bake::PathStep&) { return true; });
}

// All that a straight path through the box scatters.
double gathered(double scattering) {
    const bake::Turns straight(dvec3(0, 0, 1), dvec3(0, 0, 1));
    return bake::gather_along_path(
        {dvec3(0.5, 0.5, 0), straight[0], 1},
        [=](dvec3) {
            return bake::Coefficients{scattering, 0};
        },
        {kUnitBox, 0.125}, [](double) { return 1.0; }, [](dvec3) { return 1.0; });
}

// Source radiance after one scattering more, straight back, beyond the last node of the table.
double deep_kernel(double ell) {
    const auto table =
        bake::make_zonal_table(bake::PathKernel::source, bake::expand_henyey_greenstein(0.9, 256));
    return bake::interpolate_row(table, -1)(ell);
}

}  // namespace

double naive_share(double absorption, double ell) {
    return std::exp(-absorption) * (std::exp(ell) - 1) / std::exp(ell);
}

StabilityField volume_rows() {
    const dvec3 up(0, 0, 1);
    const bake::Turns back(up, -up), aside(up, turned(1));
    const double length = glm::length(glm::cross(up, -up));
    return {
        "Path integration through volumes",
        {
            {"empty space on the path", "length through a box of 1 m, b 0", "ds = dℓ / b",
             textbook_length(0, 0.1),
             march({dvec3(0.5, 0.5, 0), bake::Turns(up, up)[0], 1}, {}).length, "1", 1e-14, 1},
            {"scattering depth far above 709", "share scattered; A 3, ℓ 800", "(e^ℓ − 1) / e^ℓ",
             naive_share(3, 800), bake::scattered_share(3, 800), "exp(-3)", 1e-15, 1},
            {"scattering depth → 0", "share scattered; ℓ 1e-12", "(e^ℓ − 1) / e^ℓ",
             naive_share(0, 1e-12), bake::scattered_share(0, 1e-12), "-expm1(-1e-12)", 1e-15, 1e-6},
            {"optical depth 1e-12", "∫ b ds, b 1e-12 1/m", "1 − e^−τ", 1 - std::exp(-1e-12),
             gathered(1e-12), "1e-12", 1e-14, 1e-6},
            {"moments at large depths", "mean cosine; g .9, ℓ 1000", "(e^ℓg − 1) / (e^ℓ − 1)",
             textbook_moment(0.9, 1000), bake::moment_after_many(0.9, 1000),
             "exp(-1000 * (1 - 0.9))", 1e-12, 1},
            {"moments at small depths", "mean cosine; g .9, ℓ 1e-17", "(e^ℓg − 1) / (e^ℓ − 1)",
             textbook_moment(0.9, 1e-17), bake::moment_after_many(0.9, 1e-17), "0.9", 1e-15, 1},
            {"moments at small depths", "mean cosine; g .9, ℓ 1e-15", "(e^ℓg − 1) / (e^ℓ − 1)",
             textbook_moment(0.9, 1e-15), bake::moment_after_many(0.9, 1e-15),
             "expm1(1e-15 * 0.9) / expm1(1e-15)", 1e-15, 1e-2},
            {"g ≤ 0", "mean cosine; g −.3, ℓ 3000", "the form that g > 0 needs",
             std::exp(-3000 * 1.3) * std::expm1(3000 * 0.3) / std::expm1(-3000.0),
             bake::moment_after_many(-0.3, 3000), "0", 0, 1},
            {"scattering depth far above 709", "radiance, moment of g .99; ℓ 800",
             "λ (e^ℓλ − 1) e^−ℓ", 0.99 * (std::exp(800 * 0.99) - 1) * std::exp(-800.0),
             bake::moment_of_ray(0.99, 800), "0.99 * expm1(800 * 0.99) * exp(-800)", 1e-12, 1},
            {"scattering depth far above 709", "kernel straight back; g .9, ℓ 1e6",
             "Σ (2k + 1) λ² e^(ℓλ) / e^ℓ", std::exp(1e6 * 0.9) / std::exp(1e6), deep_kernel(1e6),
             "1 / (4 * pi)", 1e-5, 1},
            {"v = l", "n in the plane of v and l", "v × l / |v × l|",
             0 / glm::length(glm::cross(up, up)), glm::length(bake::Turns(up, up)[0].aside), "0", 0,
             1},
            {"v = −l", "length of n, four planes", "v × l / |v × l|", length / length,
             (glm::length(back[0].aside) + glm::length(back[1].aside) + glm::length(back[2].aside) +
              glm::length(back[3].aside)) /
                 static_cast<double>(back.size()),
             "1", 1e-15, 1},
            {"angle near 0", "1e-9 rad", "acos(v · l)", std::acos(glm::dot(up, turned(1e-9))),
             angle_between(up, turned(1e-9)), "1e-9", 1e-15, 1},
            {"angle near π", "π − angle, angle π − 1e-9 rad", "acos(v · l)",
             pi - std::acos(glm::dot(-up, turned(1e-9))), pi - angle_between(-up, turned(1e-9)),
             "1e-9", 1e-6, 1},
            {"no depth to turn in", "cosine to l where the path ends; ℓ_total 0",
             "φ = Θ ℓ / ℓ_total", std::cos(aside[0].angle * length / length),
             glm::dot(march({dvec3(0.5), aside[0], bake::kShortestTurn}, {1, 0}).direction,
                      turned(1)),
             "1", 1e-15, 1},
            {"ray parallel to a face, start on a face", "along an edge of a box of 1 m",
             "(face − x) / direction", textbook_exit(kUnitBox, dvec3(0), dvec3(1, 0, 0)),
             bake::exit_distance(kUnitBox, dvec3(0), dvec3(1, 0, 0)), "1", 0, 1},
            {"optical depth 1e6", "∫ b e^−ℓ ds, b 1e6 1/m", "steps of 1/8 m",
             0.125e6 * std::exp(-0.0625e6),
             bake::gather_along_path(
                 {dvec3(0.5, 0.5, 0), bake::Turns(up, up)[0], 1},
                 [](dvec3) {
                     return bake::Coefficients{1e6, 0};
                 },
                 {kUnitBox, 0.125}, [](double ell) { return std::exp(-ell); },
                 [](dvec3) { return 1.0; }),
             "1", 0.02, 1},
        }};
}

}  // namespace opaline::tests
