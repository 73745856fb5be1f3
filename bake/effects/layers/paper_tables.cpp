#include "bake/effects/layers/paper_tables.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "bake/effects/layers/layer_tables.h"
#include "bake/physics/gauss_legendre.h"
#include "bake/physics/mie/phase_texture.h"
#include "bake/physics/slab/column_model.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/radiance_table.h"
#include "bake/physics/slab/solve_slab.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

struct PaperShares {
    OrderShares order;         ///< 1 and 2 of the column; 3 is what they leave, at least 0
    double transmittance = 1;  ///< T_ms
};

// T_0 is that of the slab and the orders are those of a column, so that they may exceed T_ms.
PaperShares paper_shares(double depth, double cosine, double peak_weight) {
    if (!(depth > 0)) return {};
    const ColumnModel model = paper2006_at(std::acos(std::min(cosine, 1.0)) * 180 / pi);
    const double thickness = paper_thickness(depth, peak_weight);
    PaperShares shares;
    shares.order = column_orders(model, thickness);
    shares.transmittance = std::clamp(column_transmittance(model, thickness), 0.0, 1.0);
    auto& [t, r] = shares.order;
    t[0] = std::exp(-depth / std::max(cosine, kMinSlabCosine));
    t[3] = std::max(0.0, shares.transmittance - t[0] - t[1] - t[2]);
    r[3] = std::max(0.0, 1 - shares.transmittance - r[1] - r[2]);
    return shares;
}

double mean_paper_transmittance(double depth, double peak_weight) {
    static const GaussLegendre kRule = make_gauss_legendre(48);
    double sum = 0, weights = 0;
    for (std::size_t i = 0; i < kRule.node.size(); ++i) {
        const double weight = kRule.weight[i] * kRule.node[i];
        sum += weight * paper_shares(depth, kRule.node[i], peak_weight).transmittance;
        weights += weight;
    }
    return sum / weights;
}

std::vector<double> table_cosines(const RadianceTableSize& size) {
    std::vector<double> cosines;
    for (std::size_t j = 0; j < size.cosines; ++j) {
        const double s = static_cast<double>(j) / static_cast<double>(size.cosines - 1);
        cosines.push_back(std::max(kLeastTableCosine, s * s * (3 - 2 * s)));
    }
    return cosines;
}

// pi P * P by azimuth mode: [(m * cosines + view) * cosines + light], means over the azimuth.
std::vector<double> twice_modes(const AngularTable& twice, const std::vector<double>& cosines,
                                std::size_t modes, bool transmitted) {
    constexpr std::size_t kTwiceAzimuths = 128;
    const std::size_t n = cosines.size();
    std::vector<double> values(modes * n * n, 0.0);
    for (std::size_t at = 0; at < n * n; ++at) {
        for (std::size_t a = 0; a < kTwiceAzimuths; ++a) {
            const double azimuth = pi * (static_cast<double>(a) + 0.5) / kTwiceAzimuths;
            const double angle =
                scattering_angle(cosines[at % n], cosines[at / n], azimuth, transmitted);
            const double share = pi * eval_table(twice, angle) / kTwiceAzimuths;
            for (std::size_t m = 0; m < modes; ++m) {
                values[m * n * n + at] += share * std::cos(static_cast<double>(m) * azimuth);
            }
        }
    }
    return values;
}

AngularTable scatter_twice(const PeakSplit& split) {
    constexpr unsigned kAngles = 512;
    std::vector<double> angles;
    for (unsigned i = 0; i < kAngles; ++i) {
        angles.push_back(texture_angle(i / (kAngles - 1.0)));
    }
    return convolve_with_itself(split.rest, kConvolutionMoments, angles).table;
}

// P_F^(*n) for a whole n of 1 or more.
std::vector<double> convolve_peak(const PeakSplit& split, const std::vector<double>& moments,
                                  double n, const std::vector<double>& angles) {
    std::vector<double> values;
    if (n < 2) {
        for (const double angle : angles) {
            values.push_back(eval_table(split.peak, angle));
        }
        return values;
    }
    std::vector<double> powers = moments;
    for (double& moment : powers) {
        moment = std::pow(moment, n);
    }
    return sum_moments(powers, angles);
}

}  // namespace

double paper_thickness(double depth, double peak_weight) {
    return depth / ((1 - peak_weight) * kPaper2006Extinction);
}

SlabTable make_paper_fluxes(double peak_weight, const SlabTableSize& size) {
    SlabTable table;
    table.size = size;
    for (std::size_t i = 0; i < size.depths; ++i) {
        const double depth = depth_of_node(i, size.depths, kMaxSlabDepth);
        for (std::size_t j = 0; j < size.cosines; ++j) {
            const double root = static_cast<double>(j) / static_cast<double>(size.cosines - 1);
            const PaperShares shares = paper_shares(depth, root * root, peak_weight);
            table.t1.push_back(static_cast<float>(shares.order.transmitted[1]));
            table.t2.push_back(static_cast<float>(shares.order.transmitted[2]));
            table.t_ms.push_back(static_cast<float>(shares.transmittance));
            table.r1.push_back(static_cast<float>(shares.order.reflected[1]));
            table.r2.push_back(static_cast<float>(shares.order.reflected[2]));
        }
        table.mean_t.push_back(static_cast<float>(mean_paper_transmittance(depth, peak_weight)));
    }
    return table;
}

RadianceTable make_paper_radiance(const PeakSplit& split, const RadianceTableSize& size) {
    const std::vector<double> cosines = table_cosines(size);
    const AngularTable twice = scatter_twice(split);
    RadianceTable table;
    table.size = size;
    for (const bool transmitted : {false, true}) {
        const std::vector<double> modes = twice_modes(twice, cosines, size.modes, transmitted);
        std::vector<float>& values = transmitted ? table.transmitted : table.reflected;
        for (std::size_t i = 0; i < size.depths; ++i) {
            // A layer of no depth has limits other than 0.
            constexpr double kThin = 1e-6;
            const double depth = std::max(kThin, depth_of_node(i, size.depths, kMaxSlabDepth));
            for (std::size_t at = 0; at < modes.size(); ++at) {
                const double light = cosines[at % size.cosines];
                const double view = cosines[at / size.cosines % size.cosines];
                // Radiance over mu_l / pi times the shape that the table's values are over.
                const double reflected = reflected_once(depth, light, view);
                const double scale =
                    transmitted ? transmitted_once(depth, light, view) / reflected : 1.0;
                double value = scale * modes[at];
                if (at < size.cosines * size.cosines) {
                    const OrderShares order = paper_shares(depth, light, split.weight).order;
                    const double rest = transmitted ? order.transmitted[3] : order.reflected[3];
                    value += light * rest / (2 * view * reflected);
                }
                values.push_back(static_cast<float>(value));
            }
        }
    }
    return table;
}

std::vector<float> tabulate_paper_glow(const PeakSplit& split, unsigned angles, unsigned events) {
    std::vector<float> glow;
    if (!(split.angle > 0)) return glow;
    const std::vector<double> moments = table_moments(split.peak, kGlowMoments);
    const std::vector<double> angle = glow_angles(split, angles);
    for (unsigned j = 0; j < events; ++j) {
        const double n = split.weight > 0 ? glow_events(j, events) / split.weight : 0.0;
        const double below = std::max(1.0, std::floor(n)), share = n < 1 ? 0.0 : n - below;
        const std::vector<double> low = convolve_peak(split, moments, below, angle);
        const std::vector<double> high =
            share > 0 ? convolve_peak(split, moments, below + 1, angle) : low;
        for (std::size_t i = 0; i < angle.size(); ++i) {
            // The series leaves noise around 0 where there is next to no light.
            const double value = std::min(n, 1.0) * std::lerp(low[i], high[i], share);
            glow.push_back(static_cast<float>(std::max(0.0, value)));
        }
    }
    return glow;
}

}  // namespace opaline::bake
