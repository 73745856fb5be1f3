#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <span>

#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/physics/path_differentials/bounded_change.h"
#include "bake/physics/path_differentials/footprint.h"
#include "bake/physics/path_differentials/lobe.h"
#include "bake/physics/path_differentials/path_differential.h"
#include "bake/physics/path_differentials/surface_shape.h"
#include "tests/stability/naive_forms.h"
#include "tests/stability/stability_row.h"

// Path differentials.

namespace opaline::tests {
namespace {

using bake::Lobe;
using glm::dvec2;
using glm::dvec3;
using std::numbers::pi;

double textbook_power_cosine(double exponent, double q) {
    return std::pow(1 - q, 1 / (exponent + 1));
}

// The polar map: |dD/dv| = (ds/dq) of a lobe at its axis.
double textbook_polar(double exponent, double q) {
    const double c = textbook_power_cosine(exponent, q);
    return std::pow(1 - q, 1 / (exponent + 1) - 1) / (exponent + 1) / std::sqrt(1 - c * c);
}

// |dT / dx| at c_t^2 = `square`, for d(c_t^2)/dx = 1.
double textbook_root(double square) {
    return 1 / (2 * std::sqrt(square));
}

// The frame around n whose first axis is perpendicular to z spins as n moves across by 1.
double textbook_spin(const dvec3& n) {
    return n.z / glm::length(glm::cross(n, dvec3(0, 0, 1)));
}

double carried_spin(const dvec3& n) {
    const glm::dmat3 frame = bake::frame_around(n);
    return glm::dot(bake::carry_with_axis(n, frame[1], frame[1]), frame[0]);
}

// [Frisvad2012]: without a sign it divides by 1 + n.z.
double textbook_frame(const dvec3& n) {
    const double a = 1 / (1 + n.z);
    return glm::length(dvec3(1 - n.x * n.x * a, -n.x * n.y * a, -n.x));
}

// A is the sum on one side of the first vector, B that on the other.
double textbook_pair(std::span<const dvec2> vectors) {
    dvec2 a(0), b(0);
    for (const dvec2& v : vectors) {
        const double side = vectors[0].x * v.y - vectors[0].y * v.x;
        if (side > 0) a += v;
        if (side < 0) b += v;
    }
    return std::abs(a.x * b.y - a.y * b.x);
}

// The smaller singular value from the eigenvalues of the second moments.
double textbook_minor(const bake::FootprintPair& pair) {
    const double xx = pair.A.x * pair.A.x + pair.B.x * pair.B.x,
                 yy = pair.A.y * pair.A.y + pair.B.y * pair.B.y,
                 xy = pair.A.x * pair.A.y + pair.B.x * pair.B.y;
    return std::sqrt((xx + yy) / 2 - std::sqrt((xx - yy) * (xx - yy) / 4 + xy * xy));
}

double exact_square_sine(const Lobe& lobe, double q) {
    return bake::eval_lobe(lobe, q).square_sine_over_q;
}

double area_times_pdf(double exponent) {
    const auto at = bake::sample_lobe({Lobe::Kind::power, exponent}, 0.5, 0.5);
    return glm::length(glm::cross(at.dD_du, at.dD_dv)) * (exponent + 1) / (2 * pi);
}

double disk_area(double u, double v) {
    const bake::DiskPoint at = bake::map_to_disk(u, v);
    return std::abs(at.du.radial * at.dv.tangential - at.du.tangential * at.dv.radial);
}

// The square's triangle around the x axis: radius a, angle pi / 4 b / a.
double textbook_disk_area(double u, double v) {
    const double a = 2 * u - 1, b = 2 * v - 1, angle = pi / 4 * b / a;
    return 2 * a * (pi / 4 * 2 / a) *
           (std::cos(angle) * std::cos(angle) + std::sin(angle) * std::sin(angle));
}

// How far a direction of the lobe moves along the radius within the step.
double rim_change(double exponent, double v, double step) {
    return step *
           glm::length(bake::secant_of_lobe({Lobe::Kind::power, exponent}, 0.5, v, step).dD_dv);
}

}  // namespace

double naive_square_sine(double cosine, double q) {
    return (1 - cosine * cosine) / q;
}

double naive_peak_cosine(double g, double q) {
    const double f = (1 - g * g) / (1 - g + 2 * g * (1 - q));
    return (1 + g * g - f * f) / (2 * g);
}

StabilityField differential_rows() {
    const dvec3 up(0, 0, 1), tilted(std::sqrt(1 - 1e-18), 0, -1e-9);
    const std::array<dvec2, 2> along{dvec2(1, 0), dvec2(0, 1)};
    const std::array<dvec2, 3> cancel{dvec2(1, 2), dvec2(2, 1), dvec2(-3, -3)};
    const bake::FootprintPair thin{{1, 0}, {1, 1e-12}}, none{};
    const double zero = bake::pair_area(none);
    const std::array<dvec3, 3> flat{dvec3(0), dvec3(1, 0, 0), dvec3(2, 0, 0)};
    const std::array<dvec3, 3> normals{up, glm::normalize(dvec3(1, 0, 1)), up};
    const auto henyey = Lobe::Kind::henyey_greenstein;
    return {
        "Path differentials",
        {
            {"transfer, D.N_g → 0", "footprint per beam's width, D.N_g 1e-9", "1 / (D.N_g)",
             1 / 1e-9, glm::length(bake::bounded_transfer(tilted, up, 1, dvec3(0, 0, 1), dvec3(0))),
             "1e4", 1e-6, 1},
            {"refraction near total reflection", "change of c_t by a step of 1e-12 at c_t² 0",
             "Δ / (2 c_t)", 1e-12 * textbook_root(0), bake::sqrt_secant(0, 1e-12),
             "sqrt(mpf(1e-12) / 2)", 1e-15, 1},
            {"refraction near total reflection", "change of c_t by a step of 1.3e-15 at c_t² 1",
             "√(z + Δ/2) − √(z − Δ/2)", std::sqrt(1 + 0.65e-15) - std::sqrt(1 - 0.65e-15),
             bake::sqrt_secant(1, 1.3e-15),
             "sqrt(1 + mpf(1.3e-15) / 2) - sqrt(1 - mpf(1.3e-15) / 2)", 1e-15, 1e-3},
            {"total reflection itself", "whether light is refracted; cos .1, η 1.5",
             "√(1 − η² sin²)", std::sqrt(1 - 1.5 * 1.5 * (1 - 0.1 * 0.1)),
             bake::make_refraction(dvec3(std::sqrt(0.99), 0, -0.1), up, 1.5) ? 1.0 : 0.0, "0", 0,
             1},
            {"lobe axis", "area times density, S 40", "polar map, ds/dv at v 0",
             textbook_polar(40, 0), area_times_pdf(40), "1", 1e-14, 1},
            {"lobe rim", "change of direction by a step of 1e-3 at v 1, S 1", "1 / (2 π p)",
             1e-3 * textbook_polar(1, 1), rim_change(1, 1 - 1e-13, 1e-3),
             "sqrt(1 - (1 - mpf(1e-3)) ** 2)", 1e-6, 1},
            {"concentric centre", "area of the columns", "φ = π/4 b / a",
             textbook_disk_area(0.5, 0.5), disk_area(0.5, 0.5), "pi", 1e-15, 1},
            {"huge exponent", "sin² / q; S 1e12, q 1e-6", "1 − c²",
             naive_square_sine(textbook_power_cosine(1e12, 1e-6), 1e-6),
             exact_square_sine({Lobe::Kind::power, 1e12}, 1e-6),
             "-expm1(2 * log1p(-1e-6) / (1e12 + 1)) / 1e-6", 1e-15, 0.5},
            {"huge exponent", "sin² / q; S 1e6, q 1e-3", "1 − c²",
             naive_square_sine(textbook_power_cosine(1e6, 1e-3), 1e-3),
             exact_square_sine({Lobe::Kind::power, 1e6}, 1e-3),
             "-expm1(2 * log1p(-1e-3) / (1e6 + 1)) / 1e-3", 1e-15, 1e-9},
            {"Henyey–Greenstein, g → 0", "cosine; g 1e-12, q .3", "(1 + g² − f²) / (2 g)",
             naive_peak_cosine(1e-12, 0.3), bake::eval_lobe({henyey, 1e-12}, 0.3).cosine,
             "lobe(1e-12, 0.3)", 1e-15, 1e-6},
            {"Henyey–Greenstein, g → 0", "cosine; g 0, q .3", "(1 + g² − f²) / (2 g)",
             naive_peak_cosine(0, 0.3), bake::eval_lobe({henyey, 0}, 0.3).cosine, "0.4", 1e-15, 1},
            {"Henyey–Greenstein, forward peak", "sin² / q; g .999, q 1e-9", "1 − c²",
             naive_square_sine(naive_peak_cosine(0.999, 1e-9), 1e-9),
             exact_square_sine({henyey, 0.999}, 1e-9), "(1 - lobe(0.999, 1e-9) ** 2) / 1e-9", 1e-12,
             1e-3},
            {"axis of a lobe parallel to a reference axis", "spin as the axis moves by 1",
             "frame of z × R", textbook_spin(glm::normalize(dvec3(1e-9, 0, 1))),
             carried_spin(glm::normalize(dvec3(1e-9, 0, 1))), "0", 1e-15, 1},
            {"jump of the frame", "length of T around (0, 0, −1)", "1 / (1 + n.z)",
             textbook_frame(dvec3(0, 0, -1)), glm::length(bake::frame_around(dvec3(0, 0, -1))[0]),
             "1", 1e-15, 1},
            {"triangle without area", "curvature", "1 / (n.n)", 1 / zero,
             glm::length(bake::interpolated_shape(flat, normals, dvec3(1, 0, 0)).dN_dP[0]), "0", 0,
             1},
            {"zero columns", "area of the footprint", "√(area / area of the pair)",
             std::sqrt(zero / zero), bake::pair_area(bake::polygon_pair({})), "0", 0, 1},
            {"parallel columns", "width of (1, 0), (1, 1e-12)", "eigenvalues of the moments",
             textbook_minor(thin),
             bake::pair_extent(bake::rms_pair(std::array{thin.A, thin.B})).minor,
             "minor(1, 0, 1, 1e-12)", 1e-12, 1e-3},
            {"vectors along the split line", "area of (1, 0), (0, 1)",
             "sums of both sides of the first", textbook_pair(along),
             bake::pair_area(bake::best_pair(along)), "1", 1e-15, 1},
            {"sign flips", "area of (1, 2), (2, 1), (−3, −3)", "sums of both sides of the first",
             textbook_pair(cancel), bake::pair_area(bake::polygon_pair(cancel)), "9", 1e-15, 0.5},
            {"very large footprints", "step of a path of survival 1e-6, two numbers",
             "(N p)^(−1/2)", 1 / std::sqrt(1e-6), bake::global_step(1, 2, 1e-6), "1", 0, 1},
        }};
}

}  // namespace opaline::tests
