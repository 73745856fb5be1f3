#pragma once

#include <complex>
#include <cstddef>
#include <span>

#include "bake/base/context.h"
#include "bake/physics/mie/angular_table.h"
#include "bake/physics/mie/droplets.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// How finely radii are sampled.
struct RadiusSampling {
    /// Step of the size parameter where most of the cross-section lies (place_radii).
    double size_step = 0.03;
    /// Bounds on the number of radii, whatever the step; even.
    unsigned least = 1000, most = 8000;
};

/// Numerical error, relative: half the difference between the means over the even and over the odd
/// radii, which is what the mean of both errs by if the halves err independently.
struct OpticsError {
    double phase_rms = 0, phase_max = 0;  ///< over the rows of the phase function
    double c_ext = 0, c_sca = 0;
    double g = 0;  ///< absolute
};

/// What droplets of one distribution do to light of one wavelength: means over the droplets.
/// Cross-sections add, so phase functions are weighted by scattered power [BohrenHuffman1983].
struct DropletOptics {
    double wavelength = 0;        ///< [m]
    std::complex<double> index;   ///< of the droplets
    double c_ext = 0, c_sca = 0;  ///< extinction and scattering cross-section [m^2]
    double c_abs = 0;             ///< absorption cross-section, summed by itself [m^2]
    double c_geo = 0;             ///< mean geometric cross-section, pi <r^2> [m^2]
    double g = 0;                 ///< mean cosine, from the coefficients
    AngularTable phase;           ///< integrates to 1 over the sphere [1/sr]
    /// Rows of `phase`: half of what the even radii's mean is above that of the odd ones, signed
    /// [1/sr]. An error that directions share is not in it: both means integrate to 1.
    AngularTable phase_error;
    double integral_before = 1;  ///< of the phase function before it was scaled to 1
    OpticsError error;
    std::size_t radii = 0;  ///< spheres that were computed
};

/// 1 - albedo = c_abs / c_ext; 1 - omega of droplets of water is below 1e-5 in visible light.
double absorbed_share(const DropletOptics& optics);

/// kappa = N0 c_ext [1/m].
double extinction(const DropletDistribution& droplets, const DropletOptics& optics);

/// Averages over the distribution at one wavelength [m], k = 2 pi / wavelength. The phase function
/// has rows at angles whose steps follow the droplets that weigh most ahead, of size parameter
/// X = k (gamma + 4) r_n: 2.4 / X degrees at both ends (0.02 degrees for droplets of 7 um), 12 / X
/// in between, but at least 0.1. The same bits for any number of threads. About a second on one
/// core for effective radii of 7 um. Errors: `usage` for a distribution, an index or a wavelength
/// out of range, and where the largest droplets have a size parameter above 2e4; `interrupted`.
formats::Result<DropletOptics> average_droplets(const DropletDistribution& droplets,
                                                double wavelength, std::complex<double> index,
                                                const RadiusSampling& sampling,
                                                const Context& context);

/// One colour channel from several wavelengths of the same droplets, which an observer weights by
/// `weights` [1], >= 0 and not all 0: cross-sections are weighted means, and so are phase functions
/// and mean cosines, by scattered power too [Bouthors2006]. Rows are those of the wavelength with
/// most of them. `wavelength` and `index` are weighted means and describe the channel; errors are
/// the largest. Three wavelengths a channel take the hard colours out of a glory.
/// Precondition: as many weights as wavelengths, at least one.
DropletOptics mix_wavelengths(std::span<const DropletOptics> optics,
                              std::span<const double> weights);

}  // namespace opaline::bake
