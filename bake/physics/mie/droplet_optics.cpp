#include "bake/physics/mie/droplet_optics.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/physics/mie/droplets.h"
#include "bake/physics/mie/mie_series.h"
#include "bake/physics/mie/sphere_scattering.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

constexpr double kMaxDropletSize = 2e4;  // size parameter of the largest droplets
/// Cross-sections are summed over this many radii for each one of intensities, which cost 50 times
/// as much: absorption comes from resonances much narrower than a step.
constexpr std::size_t kFiner = 8;
constexpr double kRadiansPerDegree = pi / 180;

/// Sums over droplets of one half, even or odd radii.
struct HalfSums {
    double extinction = 0, scattering = 0, absorption = 0;  // [m^2]
    double asymmetry = 0;                                   // of the scattering cross-section [m^2]
    std::vector<double> intensity;                          // of (|S_1|^2 + |S_2|^2) / 2
    double scattering_of_directions = 0;  // of the droplets whose intensities these are [m^2]
};

void add_sums(const HalfSums& from, HalfSums& to) {
    to.extinction += from.extinction;
    to.scattering += from.scattering;
    to.absorption += from.absorption;
    to.asymmetry += from.asymmetry;
    to.scattering_of_directions += from.scattering_of_directions;
    for (std::size_t i = 0; i < to.intensity.size(); ++i) {
        to.intensity[i] += from.intensity[i];
    }
}

using BothSums = std::array<HalfSums, 2>;

BothSums empty_sums(std::size_t angles) {
    BothSums sums;
    for (HalfSums& half : sums) {
        half.intensity.assign(angles, 0.0);
    }
    return sums;
}

/// Rows fine enough for the droplets that weigh most ahead: r^4 n(r) has the mean (gamma + 4) r_n.
AngleGrid choose_angles(double wave_number, const DropletDistribution& droplets) {
    const double size = wave_number * (droplets.gamma + 4) * characteristic_radius(droplets);
    const double first = std::clamp(2.4 / size, 1e-3, 0.5) * kRadiansPerDegree;
    const double most = std::clamp(12 / size, 0.1, 0.5) * kRadiansPerDegree;
    return make_angle_grid(first, most, 0.01);
}

struct Sphere {
    double wave_number = 0;
    std::complex<double> index;
};

/// Adds the intensities of one droplet.
void add_directions(const RadiusNode& node, const Sphere& sphere, const AngleGrid& grid,
                    MieSeries& series, HalfSums& sums) {
    const double x = sphere.wave_number * node.radius;
    if (x < kMinSizeParameter || !(node.share > 0)) return;
    expand_sphere(x, sphere.index, series);
    add_intensities(series, grid, node.share, sums.intensity);
    sums.scattering_of_directions +=
        node.share * pi * node.radius * node.radius * sum_efficiencies(x, series).q_sca;
}

/// Adds the cross-sections of one droplet.
void add_sections(const RadiusNode& node, const Sphere& sphere, MieSeries& series, HalfSums& sums) {
    const double x = sphere.wave_number * node.radius;
    if (x < kMinSizeParameter || !(node.share > 0)) return;
    const MieEfficiencies q = sphere_efficiencies(x, sphere.index, series);
    const double section = node.share * pi * node.radius * node.radius;
    sums.extinction += section * q.q_ext;
    sums.scattering += section * q.q_sca;
    sums.absorption += section * q.q_abs;
    sums.asymmetry += section * q.q_sca * q.g;
}

OpticsError compare_halves(const BothSums& sums) {
    const HalfSums &a = sums[0], &b = sums[1];
    const auto differ = [](double p, double q) {
        return p + q > 0 ? std::abs(p - q) / (p + q) : 0;
    };
    OpticsError error;
    error.c_ext = differ(a.extinction, b.extinction);
    error.c_sca = differ(a.scattering, b.scattering);
    error.g = std::abs(a.asymmetry / a.scattering - b.asymmetry / b.scattering) / 2;
    double squares = 0;
    for (std::size_t i = 0; i < a.intensity.size(); ++i) {
        const double relative = differ(a.intensity[i] / a.scattering_of_directions,
                                       b.intensity[i] / b.scattering_of_directions);
        squares += relative * relative;
        error.phase_max = std::max(error.phase_max, relative);
    }
    error.phase_rms = std::sqrt(squares / static_cast<double>(a.intensity.size()));
    return error;
}

// What halves differ by as phase functions of their own.
AngularTable halve_difference(const BothSums& sums, const AngleGrid& grid) {
    std::array<AngularTable, 2> half;
    for (std::size_t k = 0; k < half.size(); ++k) {
        for (std::size_t i = 0; i < grid.size(); ++i) {
            half[k].angle.push_back(grid.angle(i));
            half[k].value.push_back(sums[k].intensity[i]);
        }
        const double integral = integrate_table(half[k]);
        if (integral > 0) scale_table(half[k], 1 / integral);
    }
    AngularTable difference = std::move(half[0]);
    for (std::size_t i = 0; i < difference.value.size(); ++i) {
        difference.value[i] = (difference.value[i] - half[1].value[i]) / 2;
    }
    return difference;
}

formats::Status check_inputs(const DropletDistribution& droplets, double wavelength,
                             std::complex<double> index) {
    if (auto status = check_droplets(droplets); !status) return status;
    if (!(wavelength > 0 && std::isfinite(wavelength))) {
        return formats::make_error(formats::ErrorKind::usage, "", "wavelength",
                                   number_text(wavelength) + " m is not a length above 0");
    }
    if (auto status = check_sphere(1, index); !status) return status;
    if (index == 1.0) {
        return formats::make_error(formats::ErrorKind::usage, "", "index of refraction",
                                   "droplets of index 1 scatter nothing",
                                   "give the index relative to the air");
    }
    const double largest = 2 * pi / wavelength * radius_range(droplets).most;
    if (!(largest <= kMaxDropletSize)) {
        return formats::make_error(
            formats::ErrorKind::usage, "", "effective radius",
            "the largest droplets have a size parameter of " + number_text(largest) +
                ", above 20000",
            "give smaller droplets: such large ones follow geometric optics");
    }
    if (!(2 * pi / wavelength * radius_range(droplets).most >= 1e-6)) {
        return formats::make_error(formats::ErrorKind::usage, "", "effective radius",
                                   "droplets so much smaller than the wavelength scatter nothing",
                                   "give a radius above a millionth of the wavelength");
    }
    return formats::ok_status();
}

}  // namespace

double absorbed_share(const DropletOptics& optics) {
    return optics.c_abs / optics.c_ext;
}

double extinction(const DropletDistribution& droplets, const DropletOptics& optics) {
    return droplets.density * optics.c_ext;
}

formats::Result<DropletOptics> average_droplets(const DropletDistribution& droplets,
                                                double wavelength, std::complex<double> index,
                                                const RadiusSampling& sampling,
                                                const Context& context) {
    if (auto status = check_inputs(droplets, wavelength, index); !status) {
        return std::move(status).error();
    }
    const Sphere sphere{2 * pi / wavelength, index};
    const RadiusRange range = radius_range(droplets);
    const double steps = sphere.wave_number * range.weighted_length / sampling.size_step;
    const auto pairs = static_cast<unsigned>(
        std::ceil(std::clamp(steps / 2, sampling.least / 2.0, sampling.most / 2.0)));
    const std::vector<RadiusNode> nodes = place_radii(droplets, 2 * pairs);
    const std::vector<RadiusNode> finer = place_radii(droplets, kFiner * 2 * pairs);
    const AngleGrid grid = choose_angles(sphere.wave_number, droplets);

    constexpr std::size_t kBlock = 16;
    BothSums sums = empty_sums(grid.size());
    for_each_block_in_order(
        nodes.size(), kBlock, context,
        [&](Range block) {
            BothSums part = empty_sums(grid.size());
            MieSeries series;
            for (std::size_t i = block.begin; i < block.end; ++i) {
                add_directions(nodes[i], sphere, grid, series, part[i % 2]);
                for (std::size_t k = 0; k < kFiner; ++k) {
                    add_sections(finer[kFiner * i + k], sphere, series, part[i % 2]);
                }
            }
            return part;
        },
        [&](Range, const BothSums& part) {
            add_sums(part[0], sums[0]);
            add_sums(part[1], sums[1]);
        });
    if (context.cancelled()) {
        return formats::make_error(formats::ErrorKind::interrupted, "", "", "interrupted");
    }

    DropletOptics optics;
    optics.wavelength = wavelength;
    optics.index = index;
    optics.error = compare_halves(sums);
    optics.phase_error = halve_difference(sums, grid);
    add_sums(sums[1], sums[0]);
    const HalfSums& all = sums[0];
    optics.c_ext = all.extinction;
    optics.c_sca = all.scattering;
    optics.c_abs = all.absorption;
    optics.c_geo = mean_geometric_section(droplets);
    optics.g = all.asymmetry / all.scattering;
    optics.radii = nodes.size();
    const double scale =
        1 / (sphere.wave_number * sphere.wave_number * all.scattering_of_directions);
    for (std::size_t i = 0; i < grid.size(); ++i) {
        optics.phase.angle.push_back(grid.angle(i));
        optics.phase.value.push_back(scale * all.intensity[i]);
    }
    optics.integral_before = integrate_table(optics.phase);
    scale_table(optics.phase, 1 / optics.integral_before);
    return optics;
}

DropletOptics mix_wavelengths(std::span<const DropletOptics> optics,
                              std::span<const double> weights) {
    assert(!optics.empty() && optics.size() == weights.size());
    DropletOptics mean;
    const auto most_rows = std::max_element(optics.begin(), optics.end(),
                                            [](const DropletOptics& a, const DropletOptics& b) {
                                                return a.phase.angle.size() < b.phase.angle.size();
                                            });
    mean.phase.angle = most_rows->phase.angle;
    mean.phase.value.assign(mean.phase.angle.size(), 0.0);
    mean.phase_error = mean.phase;
    mean.integral_before = 0;
    double total = 0, scattered = 0;
    for (std::size_t k = 0; k < optics.size(); ++k) {
        total += weights[k];
        scattered += weights[k] * optics[k].c_sca;
    }
    for (std::size_t k = 0; k < optics.size(); ++k) {
        const DropletOptics& one = optics[k];
        const double weight = weights[k] / total, power = weights[k] * one.c_sca / scattered;
        mean.wavelength += weight * one.wavelength;
        mean.index += weight * one.index;
        mean.c_ext += weight * one.c_ext;
        mean.c_sca += weight * one.c_sca;
        mean.c_abs += weight * one.c_abs;
        mean.c_geo += weight * one.c_geo;
        mean.g += power * one.g;
        mean.integral_before += power * one.integral_before;
        mean.radii += one.radii;
        mean.error.phase_rms = std::max(mean.error.phase_rms, one.error.phase_rms);
        mean.error.phase_max = std::max(mean.error.phase_max, one.error.phase_max);
        mean.error.c_ext = std::max(mean.error.c_ext, one.error.c_ext);
        mean.error.c_sca = std::max(mean.error.c_sca, one.error.c_sca);
        mean.error.g = std::max(mean.error.g, one.error.g);
        for (std::size_t i = 0; i < mean.phase.angle.size(); ++i) {
            mean.phase.value[i] += power * eval_table(one.phase, mean.phase.angle[i]);
            mean.phase_error.value[i] += power * eval_table(one.phase_error, mean.phase.angle[i]);
        }
    }
    scale_table(mean.phase, 1 / integrate_table(mean.phase));
    return mean;
}

}  // namespace opaline::bake
