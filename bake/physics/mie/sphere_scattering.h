#pragma once

#include <complex>
#include <span>
#include <vector>

#include "bake/physics/mie/mie_series.h"

namespace opaline::bake {

/// Cross-sections of a sphere divided by its geometric one, pi r^2 [BohrenHuffman1983].
struct MieEfficiencies {
    double q_ext = 0, q_sca = 0;  ///< extinction, scattering
    double q_abs = 0;             ///< absorption, summed by itself: digits survive where it is tiny
    double q_back = 0;            ///< backscattering, radar convention: 4 |S_1(pi)|^2 / x^2
    double g = 0;                 ///< mean cosine of the scattering angle; 0 where q_sca is 0
};

/// From the coefficients of a sphere of size parameter x.
MieEfficiencies sum_efficiencies(double x, const MieSeries& series);

/// Efficiencies of one sphere, relative error about 1e-12; `series` is working memory. A sphere of
/// index 1 scatters nothing: all zero. Precondition: check_sphere.
MieEfficiencies sphere_efficiencies(double x, std::complex<double> m, MieSeries& series);
MieEfficiencies sphere_efficiencies(double x, std::complex<double> m);

/// Angles from 0 to pi that lie symmetrically around pi / 2, which is one of them, so that both
/// halves share the angular functions.
struct AngleGrid {
    std::vector<double> half;         ///< [rad], ascending from 0 to pi / 2
    std::vector<double> half_cosine;  ///< of these
    std::size_t size() const { return 2 * half.size() - 1; }
    double angle(std::size_t i) const;  ///< [rad], ascending; angle(size() - 1) = pi
};

/// Angles whose steps grow from `first` at both ends to `most` in the middle, by `growth` of the
/// distance from the nearer end. All in radians, first > 0.
AngleGrid make_angle_grid(double first, double most, double growth);

/// Adds weight (|S_1|^2 + |S_2|^2) / 2 of the sphere at every angle of the grid to `sum`, of
/// grid.size() elements. Four angles at a time; the same bits on every machine.
void add_intensities(const MieSeries& series, const AngleGrid& grid, double weight,
                     std::span<double> sum);

}  // namespace opaline::bake
