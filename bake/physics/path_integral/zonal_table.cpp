#include "bake/physics/path_integral/zonal_table.h"

#include <algorithm>
#include <cmath>

#include "bake/physics/phase.h"

namespace opaline::bake {
namespace {

// Widths of peaks in the cosine: no narrower than a float of 1 can tell, and none at all.
constexpr double kNarrowest = 1e-5, kNoPeak = 4;

// Scattering depth, in units of 1 / (1 - lambda), beyond which light has no direction: e^-16.
constexpr double kEven = 16;

// Four nodes and their weights in the cubic through them.
struct Cubic {
    std::size_t first;
    std::array<float, 4> weight;
};

// `position` in units of nodes, of which there are `count`.
Cubic place_cubic(float position, int count) {
    const int first = std::clamp(static_cast<int>(position) - 1, 0, count - 4);
    const float u = position - static_cast<float>(first);
    const float a = u - 1, b = u - 2, c = u - 3;
    return {static_cast<std::size_t>(first),
            {-a * b * c * (1.0f / 6), u * b * c * 0.5f, -u * a * c * 0.5f, u * a * b * (1.0f / 6)}};
}

// Width of the peak at cosine 1, or -1, of a zonal function: of a Henyey-Greenstein function
// (w + 1 - cosine)^(-3/2) it is w.
double peak_width(const std::vector<double>& moment, bool backward) {
    double value = 0, slope = 0;
    for (std::size_t l = 0; l < moment.size(); ++l) {
        const auto degree = static_cast<double>(l);
        const double term = (backward && l % 2 == 1 ? -1 : 1) * (2 * degree + 1) * moment[l];
        value += term;
        slope += term * degree * (degree + 1) / 2;  // P_l'(1), away from the other end
    }
    return value > 0 && slope > 0 ? std::clamp(1.5 * value / slope, kNarrowest, kNoPeak) : kNoPeak;
}

double coordinate(const ZonalTable& table, double cosine) {
    return std::log((table.forward + 1 - cosine) / (table.backward + 1 + cosine));
}

double cosine_of(const ZonalTable& table, double coordinate) {
    const double ratio = std::exp(coordinate);
    return std::clamp((table.forward + 1 - ratio * (table.backward + 1)) / (1 + ratio), -1.0, 1.0);
}

// A table up to the depth `even`. `moments_at`: std::vector<double>(double ell).
template <class Moments>
ZonalTable tabulate(PathKernel kernel, const PhaseSeries& series, double even,
                    const Moments& moments_at) {
    ZonalTable table;
    table.kernel = kernel;
    // The fewest scatterings, two or one, have the narrowest peak. Of a phase function that peaks
    // backward, an even number of them peaks forward and an odd one backward.
    std::vector<double> once, twice, thrice;
    for (const double lambda : series.lambda) {
        once.push_back(lambda);
        twice.push_back(lambda * lambda);
        thrice.push_back(lambda * lambda * lambda);
    }
    const bool is_once = kernel == PathKernel::boundary;
    table.forward = peak_width(is_once ? once : twice, false);
    table.backward = peak_width(is_once ? once : thrice, true);
    table.depth_spacing = std::log1p(even) / (ZonalTable::kDepths - 1);

    const double first = coordinate(table, 1), last = coordinate(table, -1);
    table.value.resize(std::size_t{ZonalTable::kCosines} * ZonalTable::kDepths);
    for (std::size_t depth = 0; depth < ZonalTable::kDepths; ++depth) {
        const std::vector<double> moment =
            moments_at(std::expm1(static_cast<double>(depth) * table.depth_spacing));
        for (std::size_t i = 0; i < ZonalTable::kCosines; ++i) {
            const double share = static_cast<double>(i) / (ZonalTable::kCosines - 1);
            table.value[i * ZonalTable::kDepths + depth] = static_cast<float>(
                eval_zonal(moment, cosine_of(table, first + (last - first) * share)));
        }
    }
    return table;
}

}  // namespace

std::vector<double> path_moments(PathKernel kernel, const PhaseSeries& series, double ell) {
    std::vector<double> moment;
    moment.reserve(series.lambda.size());
    for (const double lambda : series.lambda) {
        moment.push_back(kernel == PathKernel::ray ? lambda * moment_after_many(lambda, ell)
                                                   : moment_of_source(lambda, ell));
    }
    return moment;
}

double kernel_factor(PathKernel kernel, double ell) {
    return kernel == PathKernel::source ? 1.0 : -std::expm1(-ell);
}

ZonalTable make_zonal_table(PathKernel kernel, const PhaseSeries& series) {
    double slowest = 0;
    for (std::size_t l = 1; l < series.lambda.size(); ++l) {
        slowest = std::max(slowest, series.lambda[l]);
    }
    return tabulate(kernel, series, kEven / (1 - slowest),
                    [&](double ell) { return path_moments(kernel, series, ell); });
}

ZonalTable make_power_table(PathKernel kernel, const formats::PhaseFunction& phase,
                            unsigned degrees) {
    const PhaseSeries series = expand_phase(phase, degrees);
    return tabulate(kernel, series, depth_of_even_power(phase), [&](double ell) {
        std::vector<double> moment = power_moments(phase, ell, degrees);
        for (std::size_t l = 0; kernel == PathKernel::ray && l < moment.size(); ++l) {
            moment[l] *= series.lambda[l];
        }
        return moment;
    });
}

double ZonalRow::operator()(double ell) const {
    constexpr auto kLast = static_cast<float>(ZonalTable::kDepths - 1);
    const auto depth = static_cast<float>(std::min(ell, 1e30));  // beyond all nodes
    const float position = std::min(std::log(1 + depth) * nodes_per_log, kLast);
    const Cubic cubic = place_cubic(position, ZonalTable::kDepths);
    const float* const node = value.data() + cubic.first;
    const float sum = cubic.weight[0] * node[0] + cubic.weight[1] * node[1] +
                      cubic.weight[2] * node[2] + cubic.weight[3] * node[3];
    return static_cast<double>(sum) * kernel_factor(kernel, ell);
}

ZonalRow interpolate_row(const ZonalTable& table, double cosine) {
    const double first = coordinate(table, 1), last = coordinate(table, -1);
    const double share =
        (coordinate(table, std::clamp(cosine, -1.0, 1.0)) - first) / (last - first);
    const Cubic cubic =
        place_cubic(static_cast<float>(share * (ZonalTable::kCosines - 1)), ZonalTable::kCosines);
    ZonalRow row;
    row.kernel = table.kernel;
    row.nodes_per_log = static_cast<float>(1 / table.depth_spacing);
    for (std::size_t i = 0; i < 4; ++i) {
        const float* const node = table.value.data() + (cubic.first + i) * ZonalTable::kDepths;
        for (std::size_t depth = 0; depth < ZonalTable::kDepths; ++depth) {
            row.value[depth] += cubic.weight[i] * node[depth];
        }
    }
    return row;
}

}  // namespace opaline::bake
