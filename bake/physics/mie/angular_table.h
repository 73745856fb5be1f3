#pragma once

#include <span>
#include <vector>

#include "bake/physics/phase_series.h"

namespace opaline::bake {

/// A function of the scattering angle, linear in its cosine between rows and 0 outside of them.
/// Near 0 and pi every smooth phase function is linear in the cosine, so that rows can lie far
/// apart there. As a phase function it integrates to 1 over the sphere (the program's convention).
struct AngularTable {
    std::vector<double> angle;  ///< [rad], strictly ascending, in [0, pi]; two rows or more
    std::vector<double> value;  ///< [1/sr]; >= 0 but for differences of phase functions
};

/// cos(a) - cos(b), without cancellation.
double cosine_difference(double a, double b);

/// 2 pi int of the table over the cosine: 1 for a phase function. Exact for the interpolant.
double integrate_table(const AngularTable& table);

/// The same over angles up to `angle` [rad].
double integrate_within(const AngularTable& table, double angle);

/// 2 pi int of the table times the cosine: the mean cosine of a phase function.
double integrate_cosine(const AngularTable& table);

/// Value at an angle [rad].
double eval_table(const AngularTable& table, double angle);

/// Multiplies all values.
void scale_table(AngularTable& table, double factor);

/// 2 pi int of the table times P_l(cosine) for l < count: 1 and the mean cosine of a phase function
/// come first (bake/physics/phase_series.h, lambda_l). Gauss's rule on every interval, with
/// nodes enough for the fastest of the polynomials; relative error 1e-10 of the largest moment.
std::vector<double> table_moments(const AngularTable& table, unsigned count);

/// The first moments of a phase function, and what they leave out. `degrees` 1 or more.
PhaseSeries expand_table(const AngularTable& phase, unsigned degrees);

/// Sum of (2 l + 1) / (4 pi) moment_l P_l(cos angle) [1/sr] at each angle.
std::vector<double> sum_moments(std::span<const double> moments, std::span<const double> angles);

/// The table with as few rows as keep every row left out within `tolerance`, relative, of the line
/// between its neighbours: rows crowd at the forward peak, the fogbow and the glory. The ends stay.
AngularTable thin_table(const AngularTable& table, double tolerance);

/// The table between two angles of [0, pi], with rows at both.
AngularTable cut_table(const AngularTable& table, double from, double to);

}  // namespace opaline::bake
