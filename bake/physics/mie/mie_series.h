#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "formats/opal/result.h"

namespace opaline::bake {

/// What the functions of this room accept. A size parameter is x = 2 pi r / wavelength of a sphere
/// of radius r; an index is that of the sphere relative to its surroundings, m = m_r + i m_i, with
/// m_i >= 0 for absorption.
inline constexpr double kMinSizeParameter = 1e-12, kMaxSizeParameter = 1e6;
inline constexpr double kMinIndex = 1e-3, kMaxIndex = 1e3;  ///< of m_r; m_i in [0, kMaxIndex]

/// Errors: `usage`, naming what is out of range (NaN included) and the range.
formats::Status check_sphere(double size_parameter, std::complex<double> index);

/// Coefficients of the field that a homogeneous sphere scatters, in vector spherical harmonics
/// [BohrenHuffman1983], for time dependence e^(-i omega t). Element n - 1 belongs to the order n.
struct MieSeries {
    std::vector<std::complex<double>> a, b;  ///< electric and magnetic multipoles
    /// Re(a_n + b_n) - |a_n|^2 - |b_n|^2 >= 0, computed without that difference: 0 where m_i = 0.
    std::vector<double> absorbed;

    /// Working memory, kept from one sphere to the next: Riccati-Bessel functions of x.
    std::vector<double> psi, chi, ratio;
    std::vector<std::complex<double>> inner;  ///< psi_{n+1}(m x) / psi_n(m x)
};

/// Orders that matter for a sphere of size parameter x [Wiscombe1980]: beyond, |a_n|^2 + |b_n|^2 is
/// below about 1e-13. `x` in [0, kMaxSizeParameter].
std::size_t count_mie_orders(double x);

/// Computes the coefficients of a sphere into `series`, whose memory is used again. Accurate to
/// about 1e-12, for m near 1 to 1e-15 / |m - 1|. Work: proportional to max(x, |m| x).
/// Precondition: check_sphere.
void expand_sphere(double x, std::complex<double> m, MieSeries& series);

}  // namespace opaline::bake
