#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include "bake/physics/mie/mie_series.h"
#include "bake/physics/mie/sphere_scattering.h"
#include "tests/stability/naive_forms.h"
#include "tests/stability/stability_row.h"

// Spheres.

namespace opaline::tests {
namespace {

using Complex = std::complex<double>;
using Efficiency = double bake::MieEfficiencies::*;

// psi_n(z) upward, n = 0, 1, ...
std::vector<Complex> upward_psi(Complex z, std::size_t orders) {
    std::vector<Complex> psi{std::sin(z), std::sin(z) / z - std::cos(z)};
    for (std::size_t n = 1; n < orders; ++n) {
        psi.push_back(static_cast<double>(2 * n + 1) / z * psi[n] - psi[n - 1]);
    }
    return psi;
}

StabilityRow sphere_row(std::string hard_case, std::string inputs, std::string form, double x,
                        Complex m, Efficiency what, std::string exact, double bound,
                        double naive_errs) {
    return {std::move(hard_case),
            std::move(inputs),
            std::move(form),
            naive_mie(x, m).*what,
            bake::sphere_efficiencies(x, m).*what,
            std::move(exact),
            bound,
            naive_errs};
}

}  // namespace

bake::MieEfficiencies naive_mie(double x, Complex m) {
    const std::size_t orders = bake::count_mie_orders(x);
    const std::vector<Complex> outer = upward_psi(x, orders), inner = upward_psi(m * x, orders);
    std::vector<double> chi{std::cos(x), std::cos(x) / x + std::sin(x)};
    for (std::size_t n = 1; n < orders; ++n) {
        chi.push_back(static_cast<double>(2 * n + 1) / x * chi[n] - chi[n - 1]);
    }
    bake::MieEfficiencies q;
    Complex a_before, b_before;
    double g = 0;
    for (std::size_t i = 1; i <= orders; ++i) {
        const double n = static_cast<double>(i);
        const auto slope = [n](auto f, auto before, auto z) { return before - n / z * f; };
        const Complex xi(outer[i].real(), -chi[i]), xi_before(outer[i - 1].real(), -chi[i - 1]);
        const Complex dpsi = slope(outer[i], outer[i - 1], Complex(x));
        const Complex dinner = slope(inner[i], inner[i - 1], m * x);
        const Complex dxi = slope(xi, xi_before, Complex(x));
        const Complex a =
            (m * inner[i] * dpsi - outer[i] * dinner) / (m * inner[i] * dxi - xi * dinner);
        const Complex b =
            (inner[i] * dpsi - m * outer[i] * dinner) / (inner[i] * dxi - m * xi * dinner);
        q.q_ext += 2 / (x * x) * (2 * n + 1) * (a + b).real();
        q.q_sca += 2 / (x * x) * (2 * n + 1) * (std::norm(a) + std::norm(b));
        g += (2 * n + 1) / (n * (n + 1)) * (a * std::conj(b)).real() +
             (n - 1) * (n + 1) / n * (a_before * std::conj(a) + b_before * std::conj(b)).real();
        a_before = a;
        b_before = b;
    }
    q.q_abs = q.q_ext - q.q_sca;
    q.g = 4 / (x * x) * g / q.q_sca;
    return q;
}

StabilityField mie_rows() {
    const Efficiency sca = &bake::MieEfficiencies::q_sca, abs = &bake::MieEfficiencies::q_abs,
                     ext = &bake::MieEfficiencies::q_ext, g = &bake::MieEfficiencies::g;
    const std::string upward = "ψ upward", difference = "Q_ext − Q_sca", products = "sin(mx)",
                      sums = "a a*, a b*";
    return {"Spheres",
            {
                sphere_row("far below x = 0.01", "Q_sca; x 1e-4, m 1.33", upward, 1e-4, 1.33, sca,
                           "mie(1e-4, 1.33, 0).sca", 1e-12, 1e-9),
                sphere_row("far below x = 0.01", "Q_sca; x 1e-6, m 1.33", upward, 1e-6, 1.33, sca,
                           "mie(1e-6, 1.33, 0).sca", 1e-12, 1e-4),
                sphere_row("far below x = 0.01", "g; x 1e-5, m 1.33", sums, 1e-5, 1.33, g,
                           "mie(1e-5, 1.33, 0).g", 1e-11, 1),
                sphere_row("absorbing sphere, Im(mx) > 700", "Q_sca; x 1e4, m 10 + 10i", products,
                           1e4, {10, 10}, sca, "mie(1e4, 10, 10).sca", 1e-11, 1),
                sphere_row("absorbing sphere, Im(mx) > 700", "g; x 1e4, m 10 + 10i", products, 1e4,
                           {10, 10}, g, "mie(1e4, 10, 10).g", 1e-10, 1),
                sphere_row("index huge", "Q_ext; x 1.5, m 1000 + 1000i", products, 1.5,
                           {1000, 1000}, ext, "mie(1.5, 1000, 1000).ext", 1e-12, 1),
                sphere_row("Q_ext − Q_sca of water", "Q_abs; x 10, m 1.33 + 1e-9i", difference, 10,
                           {1.33, 1e-9}, abs, "mie(10, 1.33, 1e-9).abs", 1e-12, 1e-9),
                sphere_row("Q_ext − Q_sca of water", "Q_abs; x 10, m 1.33 + 1e-14i", difference, 10,
                           {1.33, 1e-14}, abs, "mie(10, 1.33, 1e-14).abs", 1e-12, 1e-4),
            }};
}

}  // namespace opaline::tests
