#pragma once

#include <span>
#include <vector>

#include "bake/physics/mie/angular_table.h"

namespace opaline::bake {

/// A phase function as a narrow forward peak, which a cloud counts as light that goes straight on,
/// and the rest: P = P_f P_F + (1 - P_f) P_S [Bouthors2006]. Both parts integrate to 1.
struct PeakSplit {
    double angle = 0;   ///< theta_f [rad], the half angle of the peak's cone; 0: no peak
    double weight = 0;  ///< P_f, the share of scattered light inside the cone, in [0, 1)
    AngularTable peak;  ///< P_F [1/sr], 0 beyond theta_f; no rows where there is no peak
    AngularTable rest;  ///< P_S [1/sr], 0 within theta_f
};

/// Where a forward peak ends: the smallest angle [rad] beyond the steepest descent at which
/// -d(log P)/d(angle) is below 0.44 per degree. 0 where the function nowhere falls so steeply.
double find_peak_angle(const AngularTable& phase);

/// `phase` integrates to 1. `angle` in [0, pi / 2] [rad].
PeakSplit split_peak(const AngularTable& phase, double angle);

/// kappa_S = (1 - P_f) kappa, the extinction of the medium without the peak, in the unit of kappa.
double rest_extinction(const PeakSplit& split, double kappa);

/// Light scattered once or more by the peak alone on a path with `events` such scatterings on
/// average, per unit of incoming light [1/sr]: e^-u sum over n >= 1 of u^n / n! P_F^(*n), of which
/// the integral is 1 - e^-u [Goudsmit1940]. The first order comes from the table, whose edge would
/// ring in a series; `moments` of the peak (table_moments) give the others: 1500 leave 1 % of the
/// value at 4 theta_f. `events` >= 0, `angle` in [0, pi] [rad]. 0 where there is no peak.
double forward_glow(const PeakSplit& split, std::span<const double> moments, double events,
                    double angle);

/// The same at many angles, the moments' factors being computed once.
std::vector<double> forward_glow(const PeakSplit& split, std::span<const double> moments,
                                 double events, std::span<const double> angles);

/// A phase function convolved with itself: directions after two scatterings.
struct SelfConvolution {
    AngularTable table;   ///< integrates to 1 [1/sr]
    double lowest = 0;    ///< of the series, before values below 0 became 0 [1/sr]
    double integral = 1;  ///< before it was scaled to 1
};

/// P * P by the squares of Legendre moments, which is exact but for the moments left out: for a cut
/// at 5 degrees 900 leave 0.06 % of the value, and 0.4 % straight ahead, where the image of the
/// edge is a cusp. At the angles given [rad], ascending from 0 to pi. Values below 0, possible with
/// few moments alone, become 0.
SelfConvolution convolve_with_itself(const AngularTable& phase, unsigned moments,
                                     std::span<const double> angles);
inline constexpr unsigned kConvolutionMoments = 900, kGlowMoments = 1500;

}  // namespace opaline::bake
