#include "bake/physics/mie/mie_series.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <type_traits>

#include "bake/physics/mie/droplets.h"

namespace opaline::bake {
namespace {

/// A complex number whose operations are plain arithmetic: those of std::complex look for NaN.
struct Pair {
    double re = 0, im = 0;
};

Pair operator-(Pair a, Pair b) {
    return {a.re - b.re, a.im - b.im};
}
Pair operator*(double s, Pair a) {
    return {s * a.re, s * a.im};
}
Pair operator*(Pair a, Pair b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

/// Between poles of the ratios psi_{n+1} / psi_n: a denominator below this counts as this.
constexpr double kLeast = 1e-100;

Pair inverse(Pair a) {
    const double norm = a.re * a.re + a.im * a.im;
    if (norm < kLeast * kLeast) {
        return {1 / kLeast, 0};
    }
    const double scale = 1 / norm;
    return {scale * a.re, -scale * a.im};
}

double inverse(double a) {
    return std::abs(a) < kLeast ? 1 / kLeast : 1 / a;
}

/// Downward recurrences start this many orders above those wanted: their error falls by (z / 2 n)^2
/// an order, to less than 1e-16.
constexpr std::size_t kOrdersBeyond = 16;

/// Where the recurrence in z starts. Up to n = |z| ratios oscillate and errors do not fall.
std::size_t start_order(double size_of_z, std::size_t orders) {
    const double beyond = size_of_z + 4 * std::cbrt(size_of_z);
    return kOrdersBeyond + std::max(orders, static_cast<std::size_t>(beyond));
}

/// inner[n] = psi_{n+1}(z) / psi_n(z) for n in [1, orders], downward:
/// psi_n / psi_{n-1} = 1 / ((2 n + 1) / z - psi_{n+1} / psi_n). It never forms psi, which overflows
/// for absorbing spheres.
template <class Number>
void fill_inner(Number inverse_z, double size_of_z, std::size_t orders, MieSeries& series) {
    series.inner.resize(orders + 1);
    Number ratio{};
    for (std::size_t n = start_order(size_of_z, orders); n >= 2; --n) {
        ratio = inverse(static_cast<double>(2 * n + 1) * inverse_z - ratio);
        if (n <= orders + 1) {
            if constexpr (std::is_same_v<Number, double>) {
                series.inner[n - 1] = ratio;
            } else {
                series.inner[n - 1] = {ratio.re, ratio.im};
            }
        }
    }
}

/// psi_n(x) = x j_n(x) and chi_n(x) = -x y_n(x) for n in [0, orders + 1]. Upward where that is
/// stable: chi always, psi to n = x. Beyond, psi by its downward ratios.
void fill_outer(double x, std::size_t orders, MieSeries& series) {
    const std::size_t last = orders + 1;
    auto &psi = series.psi, &chi = series.chi, &ratio = series.ratio;
    psi.resize(last + 1);
    chi.resize(last + 1);
    ratio.resize(last + 1);
    const double inverse_x = 1 / x, sine = std::sin(x), cosine = std::cos(x);
    psi[0] = sine;
    chi[0] = cosine;
    chi[1] = cosine * inverse_x + sine;
    for (std::size_t n = 2; n <= last; ++n) {
        chi[n] = static_cast<double>(2 * n - 1) * inverse_x * chi[n - 1] - chi[n - 2];
    }
    const std::size_t top = std::min(last, static_cast<std::size_t>(x));
    if (top >= 1) {
        psi[1] = sine * inverse_x - cosine;  // not by sin(x), which may be 0
    }
    for (std::size_t n = 2; n <= top; ++n) {
        psi[n] = static_cast<double>(2 * n - 1) * inverse_x * psi[n - 1] - psi[n - 2];
    }
    double down = 0;
    for (std::size_t n = last + kOrdersBeyond; n > top; --n) {
        down = 1 / (static_cast<double>(2 * n + 1) * inverse_x - down);
        if (n <= last) {
            ratio[n] = down;
        }
    }
    for (std::size_t n = top + 1; n <= last; ++n) {
        psi[n] = ratio[n] * psi[n - 1];
    }
}

/// A coefficient p / (p - i q), and its share of absorption. p and q are f psi_n + psi_{n+1} and
/// f chi_n + chi_{n+1}.
struct Coefficient {
    Pair value;
    double absorbed = 0;
};

Coefficient make_coefficient(double f, double psi, double psi_next, double chi, double chi_next) {
    const double p = f * psi + psi_next, q = f * chi + chi_next;
    const double scale = p / (p * p + q * q);
    return {{p * scale, q * scale}, 0};
}

Coefficient make_coefficient(Pair f, double psi, double psi_next, double chi, double chi_next) {
    const Pair p{f.re * psi + psi_next, f.im * psi}, q{f.re * chi + chi_next, f.im * chi};
    const double below_re = p.re + q.im, below_im = p.im - q.re;
    const double scale = 1 / (below_re * below_re + below_im * below_im);
    // Re(p / d) - |p / d|^2 = -Im(p q*) / |d|^2 with d = p - i q, and Im(p q*) = Im f, because
    // psi_n chi_{n+1} - psi_{n+1} chi_n = 1.
    const double absorbed = std::max(0.0, -f.im * scale);
    return {{scale * (p.re * p.re + p.im * p.im) + absorbed, scale * (p.re * q.re + p.im * q.im)},
            absorbed};
}

/// a_n and b_n of [BohrenHuffman1983] with psi_n' written as (n + 1) / x psi_n - psi_{n+1}, inside
/// and outside: what then cancels for small x has been taken out.
template <class Number>
void fill_coefficients(double x, Number m, Number inverse_m, Number contrast, std::size_t orders,
                       MieSeries& series) {
    const double inverse_x = 1 / x;
    const auto& psi = series.psi;
    const auto& chi = series.chi;
    for (std::size_t n = 1; n <= orders; ++n) {
        Number ratio;
        if constexpr (std::is_same_v<Number, double>) {
            ratio = series.inner[n].real();
        } else {
            ratio = {series.inner[n].real(), series.inner[n].imag()};
        }
        const Number f = (static_cast<double>(n + 1) * inverse_x) * contrast - inverse_m * ratio;
        const Number h = -1.0 * (m * ratio);
        const auto a = make_coefficient(f, psi[n], psi[n + 1], chi[n], chi[n + 1]);
        const auto b = make_coefficient(h, psi[n], psi[n + 1], chi[n], chi[n + 1]);
        series.a[n - 1] = {a.value.re, a.value.im};
        series.b[n - 1] = {b.value.re, b.value.im};
        series.absorbed[n - 1] = a.absorbed + b.absorbed;
    }
}

}  // namespace

formats::Status check_sphere(double size_parameter, std::complex<double> index) {
    using formats::ErrorKind;
    if (!(size_parameter >= kMinSizeParameter && size_parameter <= kMaxSizeParameter)) {
        return formats::make_error(
            ErrorKind::usage, "", "size parameter",
            number_text(size_parameter) + " is not from 1e-12 to 1e6",
            "it is 2 pi radius / wavelength; larger spheres follow geometric optics");
    }
    if (!(index.real() >= kMinIndex && index.real() <= kMaxIndex && index.imag() >= 0 &&
          index.imag() <= kMaxIndex)) {
        return formats::make_error(
            ErrorKind::usage, "", "index of refraction",
            number_text(index.real()) + " + " + number_text(index.imag()) + " i is out of range",
            "give a real part from 0.001 to 1000 and an imaginary part from "
            "0 to 1000, above 0 for absorption");
    }
    return formats::ok_status();
}

std::size_t count_mie_orders(double x) {
    const double root = std::cbrt(x);
    const double orders = x <= 8     ? x + 4 * root + 1
                          : x < 4200 ? x + 4.05 * root + 2
                                     : x + 4 * root + 2;
    return static_cast<std::size_t>(std::ceil(orders));
}

void expand_sphere(double x, std::complex<double> m, MieSeries& series) {
    assert(check_sphere(x, m));
    const std::size_t orders = count_mie_orders(x);
    series.a.resize(orders);
    series.b.resize(orders);
    series.absorbed.resize(orders);
    fill_outer(x, orders, series);
    const double size_of_z = std::sqrt(std::norm(m)) * x;
    if (m.imag() == 0) {
        const double index = m.real();
        fill_inner(1 / (index * x), size_of_z, orders, series);
        fill_coefficients(x, index, 1 / index, (1 - index) * (1 + index) / (index * index), orders,
                          series);
    } else {
        const Pair index{m.real(), m.imag()}, inverse_m = inverse(index);
        const Pair difference{1 - index.re, -index.im}, sum{1 + index.re, index.im};
        fill_inner((1 / x) * inverse_m, size_of_z, orders, series);
        fill_coefficients(x, index, inverse_m, difference * sum * inverse_m * inverse_m, orders,
                          series);
    }
}

}  // namespace opaline::bake
