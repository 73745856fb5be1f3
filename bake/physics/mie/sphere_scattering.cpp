#include "bake/physics/mie/sphere_scattering.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numbers>

#include "bake/base/vector8.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

using Double4 = double __attribute__((vector_size(32)));
constexpr std::size_t kLanes = 4;

/// (2 n + 1) / (n (n + 1)) (a_n +- b_n), the same times (-1)^(n-1), and constants of the recurrence
/// of pi_n.
struct OrderTerms {
    double order, step;  ///< n, (n + 1) / n
    double plus_re, plus_im, minus_re, minus_im;
    double back_plus_re, back_plus_im, back_minus_re, back_minus_im;
};

std::vector<OrderTerms> make_terms(const MieSeries& series) {
    std::vector<OrderTerms> terms(series.a.size());
    for (std::size_t i = 0; i < terms.size(); ++i) {
        const auto n = static_cast<double>(i + 1);
        const double scale = (2 * n + 1) / (n * (n + 1));
        const auto plus = scale * (series.a[i] + series.b[i]);
        const auto minus = scale * (series.a[i] - series.b[i]);
        const double sign = i % 2 == 0 ? 1 : -1;
        terms[i] = {n,
                    (n + 1) / n,
                    plus.real(),
                    plus.imag(),
                    minus.real(),
                    minus.imag(),
                    sign * plus.real(),
                    sign * plus.imag(),
                    sign * minus.real(),
                    sign * minus.imag()};
    }
    return terms;
}

OPALINE_INLINE Double4 all4(double x) {
    return Double4{x, x, x, x};
}

/// |S_1|^2 + |S_2|^2 at four cosines (`ahead`) and at their negatives (`behind`). With
/// pi_n(-mu) = (-1)^(n-1) pi_n(mu) and tau_n(-mu) = (-1)^n tau_n(mu), the sums of S_1 + S_2 and
/// S_1 - S_2 behind take pi_n - tau_n where those ahead take pi_n + tau_n.
OPALINE_VECTOR_CLONES
void square_amplitudes(const OrderTerms* terms, std::size_t count, const double* cosines,
                       double* ahead, double* behind) {
    Double4 mu;
    std::memcpy(&mu, cosines, sizeof mu);
    Double4 before = all4(0), now = all4(1);
    Double4 sum_re = all4(0), sum_im = all4(0), difference_re = all4(0), difference_im = all4(0);
    Double4 back_sum_re = all4(0), back_sum_im = all4(0);
    Double4 back_difference_re = all4(0), back_difference_im = all4(0);
    for (std::size_t i = 0; i < count; ++i) {
        const OrderTerms& t = terms[i];
        // s, rise, tau: the recurrences of pi_n and tau_n in the order of [Wiscombe1980].
        const Double4 s = mu * now, rise = s - before;
        const Double4 tau = t.order * rise - before;
        const Double4 plus = now + tau, minus = now - tau;
        sum_re += t.plus_re * plus;
        sum_im += t.plus_im * plus;
        difference_re += t.minus_re * minus;
        difference_im += t.minus_im * minus;
        back_sum_re += t.back_plus_re * minus;
        back_sum_im += t.back_plus_im * minus;
        back_difference_re += t.back_minus_re * plus;
        back_difference_im += t.back_minus_im * plus;
        before = now;
        now = s + t.step * rise;
    }
    const Double4 front = 0.5 * (sum_re * sum_re + sum_im * sum_im + difference_re * difference_re +
                                 difference_im * difference_im);
    const Double4 back =
        0.5 * (back_sum_re * back_sum_re + back_sum_im * back_sum_im +
               back_difference_re * back_difference_re + back_difference_im * back_difference_im);
    std::memcpy(ahead, &front, sizeof front);
    std::memcpy(behind, &back, sizeof back);
}

}  // namespace

MieEfficiencies sum_efficiencies(double x, const MieSeries& series) {
    double extinction = 0, scattering = 0, absorption = 0, asymmetry = 0;
    double back_re = 0, back_im = 0, sign = -1;
    const std::size_t count = series.a.size();
    for (std::size_t i = 0; i < count; ++i) {
        const auto n = static_cast<double>(i + 1);
        const auto a = series.a[i], b = series.b[i];
        const auto product = [](std::complex<double> u, std::complex<double> v) {
            return u.real() * v.real() + u.imag() * v.imag();  // Re(u v*)
        };
        extinction += (2 * n + 1) * (a.real() + b.real());
        scattering += (2 * n + 1) * (product(a, a) + product(b, b));
        absorption += (2 * n + 1) * series.absorbed[i];
        asymmetry += (2 * n + 1) / (n * (n + 1)) * product(a, b);
        if (i + 1 < count) {
            asymmetry +=
                n * (n + 2) / (n + 1) * (product(a, series.a[i + 1]) + product(b, series.b[i + 1]));
        }
        back_re += sign * (2 * n + 1) * (a.real() - b.real());
        back_im += sign * (2 * n + 1) * (a.imag() - b.imag());
        sign = -sign;
    }
    const double scale = 2 / (x * x);
    MieEfficiencies result;
    result.q_ext = scale * extinction;
    result.q_sca = scale * scattering;
    result.q_abs = scale * absorption;
    result.q_back = (back_re / x) * (back_re / x) + (back_im / x) * (back_im / x);
    result.g = scattering > 0 ? std::clamp(2 * asymmetry / scattering, -1.0, 1.0) : 0;
    return result;
}

MieEfficiencies sphere_efficiencies(double x, std::complex<double> m, MieSeries& series) {
    if (m == 1.0) {
        return {};
    }
    expand_sphere(x, m, series);
    return sum_efficiencies(x, series);
}

MieEfficiencies sphere_efficiencies(double x, std::complex<double> m) {
    MieSeries series;
    return sphere_efficiencies(x, m, series);
}

double AngleGrid::angle(std::size_t i) const {
    return i < half.size() ? half[i] : pi - half[size() - 1 - i];
}

AngleGrid make_angle_grid(double first, double most, double growth) {
    assert(first > 0 && most >= first && growth >= 0);
    AngleGrid grid;
    for (double angle = 0; angle < pi / 2;
         angle += std::min(most, std::max(first, growth * angle))) {
        grid.half.push_back(angle);
        grid.half_cosine.push_back(std::cos(angle));
    }
    grid.half.push_back(pi / 2);
    grid.half_cosine.push_back(0);
    return grid;
}

void add_intensities(const MieSeries& series, const AngleGrid& grid, double weight,
                     std::span<double> sum) {
    assert(sum.size() == grid.size());
    const std::vector<OrderTerms> terms = make_terms(series);
    const std::size_t half = grid.half.size();
    for (std::size_t at = 0; at < half; at += kLanes) {
        double cosine[kLanes], ahead[kLanes], behind[kLanes];
        for (std::size_t k = 0; k < kLanes; ++k) {
            cosine[k] = grid.half_cosine[std::min(at + k, half - 1)];
        }
        square_amplitudes(terms.data(), terms.size(), cosine, ahead, behind);
        for (std::size_t i = at; i < std::min(at + kLanes, half); ++i) {
            sum[i] += 0.5 * weight * ahead[i - at];
            const std::size_t mirrored = grid.size() - 1 - i;
            if (mirrored != i) {
                sum[mirrored] += 0.5 * weight * behind[i - at];
            }
        }
    }
}

}  // namespace opaline::bake
