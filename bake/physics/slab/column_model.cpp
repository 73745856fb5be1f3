#include "bake/physics/slab/column_model.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>

#include "bake/physics/slab/solve_slab.h"

namespace opaline::bake {
namespace {

using Eigen::VectorXd;

/// y - 1 + e^-y for y >= 0: y^2 / 2 - y^3 / 6 + ...
double twice_turned(double y) {
    constexpr double kSeriesBelow = 0.2;
    if (y >= kSeriesBelow) return y + std::expm1(-y);
    double sum = 0, power = -y;
    for (int n = 2; n < 12; ++n) {
        power *= -y / n;
        sum += power;
    }
    return sum;
}

/// 1 - (1 + y) e^-y
double once_turned(double y) {
    return y * -std::expm1(-y) - twice_turned(y);
}

// L = b / (1 - b) metres with the printed b = 0.9961.
constexpr double kPrintedLength = 0.9961 / (1 - 0.9961);
// Light at 0, 10, ... 90 degrees.
constexpr ColumnModel kPaper2006[] = {{kPrintedLength, 1.1796, 0.0138, 0.0265, 0.8389, 0.0547},
                                      {kPrintedLength, 1.1293, 0.0154, 0.0262, 0.8412, 0.0547},
                                      {kPrintedLength, 1.1382, 0.0131, 0.0272, 0.8334, 0.0552},
                                      {kPrintedLength, 1.0953, 0.0049, 0.0294, 0.8208, 0.0564},
                                      {kPrintedLength, 0.9808, 0.0012, 0.0326, 0.8010, 0.0603},
                                      {kPrintedLength, 0.9077, 0.0047, 0.0379, 0.7774, 0.0705},
                                      {kPrintedLength, 0.7987, 0.0207, 0.0471, 0.7506, 0.0984},
                                      {kPrintedLength, 0.6629, 0.0133, 0.0616, 0.7165, 0.1700},
                                      {kPrintedLength, 0.5043, 0.0280, 0.0700, 0.7149, 0.3554},
                                      {kPrintedLength, 0.3021, 0.0783, 0.0700, 0.1000, 0.9500}};

/// A place where the sum of squares is least, found from a start.
struct LeastSquares {
    Eigen::VectorXd parameters;
    double rms = 0;      ///< of the residuals there
    double largest = 0;  ///< of their absolute values
};

/// Levenberg's damped Gauss-Newton steps with difference quotients, at most 200 of them, until a
/// step lowers the sum by less than 1e-12 of itself. Parameters stay within the box. `residuals`
/// must be finite there, and of one length.
LeastSquares minimise_squares(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& residuals,
    const Eigen::VectorXd& start, const Eigen::VectorXd& least, const Eigen::VectorXd& most) {
    constexpr int kMostSteps = 200;
    constexpr double kDifference = 1e-6, kEnough = 1e-12, kMostDamping = 1e12;
    const auto inside = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
        return x.cwiseMax(least).cwiseMin(most);
    };
    Eigen::VectorXd at = inside(start), value = residuals(at);
    double damping = 1e-3;
    for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
        Eigen::MatrixXd slope(value.size(), at.size());
        for (Eigen::Index i = 0; i < at.size(); ++i) {
            Eigen::VectorXd beside = at;
            const double shift = kDifference * std::max(1.0, std::abs(at[i]));
            beside[i] += beside[i] + shift <= most[i] ? shift : -shift;
            slope.col(i) = (residuals(beside) - value) / (beside[i] - at[i]);
        }
        const Eigen::MatrixXd normal = slope.transpose() * slope;
        const Eigen::VectorXd gradient = slope.transpose() * value;
        const double before = value.squaredNorm();
        double after = before;
        while (after >= before && damping < kMostDamping) {
            Eigen::MatrixXd damped = normal;
            damped.diagonal() += damping * (normal.diagonal().array() + 1e-300).matrix();
            const Eigen::VectorXd next = inside(at - damped.ldlt().solve(gradient));
            const Eigen::VectorXd there = residuals(next);
            after = there.squaredNorm();
            if (after < before) {
                at = next;
                value = there;
                damping /= 10;
            } else {
                damping *= 10;
            }
        }
        if (before - after <= kEnough * before) break;
    }
    return {at, std::sqrt(value.squaredNorm() / static_cast<double>(value.size())),
            value.cwiseAbs().maxCoeff()};
}

// Thick layers: T of even light is 1 / (1 + 0.75 (1 - g) depth) but for the extrapolation length,
// 1.4209 mean free paths of transport on both sides together, and beta is K(mu) / 1.066 with the
// escape function K(mu) = (3 / 7) (1 + 2 mu), roughly [vandeHulst1980].
constexpr double kExtrapolation = 1.4209, kMeanEscape = 1.066;

VectorXd vector_of(std::initializer_list<double> values) {
    VectorXd v(static_cast<Eigen::Index>(values.size()));
    Eigen::Index i = 0;
    for (const double x : values) {
        v[i++] = x;
    }
    return v;
}

/// The best of the minima found from several starts.
template <class Start>
LeastSquares best_of(std::span<const double> starts, const Start& from) {
    LeastSquares best;
    best.rms = std::numeric_limits<double>::infinity();
    for (const double start : starts) {
        const LeastSquares found = from(start);
        if (found.rms < best.rms) {
            best = found;
        }
    }
    return best;
}

/// What the model is fitted to, at one cosine: by depth.
struct ColumnTarget {
    std::vector<double> depth, transmittance;
    std::vector<OrderShares> shares;
};

void fit_transmittance(const ColumnTarget& target, double cosine, ColumnFit& fit) {
    const auto with = [&](const VectorXd& p) {
        ColumnModel model = fit.model;
        model.beta = p[0];
        model.decay = std::exp(p[1]);
        return model;
    };
    const auto residuals = [&](const VectorXd& p) {
        const ColumnModel model = with(p);
        VectorXd r(static_cast<Eigen::Index>(target.depth.size()));
        for (std::size_t i = 0; i < target.depth.size(); ++i) {
            r[static_cast<Eigen::Index>(i)] =
                column_transmittance(model, target.depth[i]) - target.transmittance[i];
        }
        return r;
    };
    const double beta = 3.0 / 7 * (1 + 2 * cosine) / kMeanEscape;
    constexpr double kDecays[] = {0.15, 0.5, 2, 12};
    const LeastSquares best = best_of(kDecays, [&](double decay) {
        return minimise_squares(residuals, vector_of({beta, std::log(decay)}),
                                vector_of({0.05, std::log(1e-3)}), vector_of({2.5, std::log(1e3)}));
    });
    fit.model = with(best.parameters);
    fit.rms_transmittance = best.rms;
    fit.max_transmittance = best.largest;
}

void fit_orders(const ColumnTarget& target, double cosine, ColumnFit& fit) {
    const auto with = [&](const VectorXd& p) {
        ColumnModel model = fit.model;
        model.extinction = std::exp(p[0]);
        model.forward = p[1];
        model.back = p[2];
        return model;
    };
    const auto residuals = [&](const VectorXd& p) {
        const ColumnModel model = with(p);
        VectorXd r(static_cast<Eigen::Index>(4 * target.depth.size()));
        Eigen::Index at = 0;
        for (std::size_t i = 0; i < target.depth.size(); ++i) {
            const OrderShares shares = column_orders(model, target.depth[i]);
            for (int n = 1; n <= 2; ++n) {
                r[at++] = shares.transmitted[n] - target.shares[i].transmitted[n];
                r[at++] = shares.reflected[n] - target.shares[i].reflected[n];
            }
        }
        return r;
    };
    constexpr double kExtinctions[] = {0.3, 1, 2};
    const LeastSquares best = best_of(kExtinctions, [&](double factor) {
        return minimise_squares(residuals, vector_of({std::log(factor / cosine), 0.8, 0.1}),
                                vector_of({std::log(1e-2), 0, 0}),
                                vector_of({std::log(1e3), 2, 2}));
    });
    fit.model = with(best.parameters);
    fit.rms_orders = best.rms;
    fit.max_orders = best.largest;
}

}  // namespace

double column_transmittance(const ColumnModel& model, double thickness) {
    return (model.beta - (model.beta - 1) * std::exp(-model.decay * thickness)) /
           (1 + thickness / model.length);
}

OrderShares column_orders(const ColumnModel& model, double thickness) {
    const double x = model.extinction * thickness, t = model.forward, r = model.back;
    const double through = std::exp(-x);
    OrderShares shares;
    shares.transmitted[0] = 0;
    if (through > 0) {  // else x may be too large to be squared
        shares.transmitted[1] = t * x * through;
        shares.transmitted[2] = (t * t * x * x / 2 + r * r / 4 * twice_turned(2 * x)) * through;
    }
    shares.reflected[1] = -r / 2 * std::expm1(-2 * x);
    shares.reflected[2] = through > 0 ? r * t / 2 * once_turned(2 * x) : r * t / 2;
    return shares;
}

OrderShares eval_column_model(const ColumnModel& model, double thickness, double straight) {
    return complete_shares(column_orders(model, thickness), straight,
                           column_transmittance(model, thickness));
}

ColumnModel paper2006_at(double degrees) {
    constexpr double kStep = 10;
    const double at = std::clamp(degrees / kStep, 0.0, std::size(kPaper2006) - 1.0);
    const auto row = std::min(static_cast<std::size_t>(at), std::size(kPaper2006) - 2);
    const double share = at - static_cast<double>(row);
    const ColumnModel &a = kPaper2006[row], &b = kPaper2006[row + 1];
    return {std::lerp(a.length, b.length, share),   std::lerp(a.beta, b.beta, share),
            std::lerp(a.decay, b.decay, share),     std::lerp(a.extinction, b.extinction, share),
            std::lerp(a.forward, b.forward, share), std::lerp(a.back, b.back, share)};
}

std::span<const double> column_fit_depths() {
    // 2 to 1000 m of the layer of [Bouthors2006].
    static constexpr double kDepths[] = {0.045, 0.11, 0.22, 0.45, 0.68, 1.1, 1.7,
                                         2.3,   3.4,  4.5,  6.8,  11,   16,  23};
    return kDepths;
}

std::vector<ColumnFit> fit_column_models(const SlabMedium& medium, std::span<const double> cosines,
                                         std::span<const double> depths, int streams) {
    SlabMedium conservative = medium;
    conservative.albedo = 1;
    std::vector<ColumnTarget> targets(cosines.size());
    for (const double depth : depths) {
        constexpr unsigned kOrders = 3;
        const SlabSolution slab =
            solve_slab(conservative, {depth, 0, {cosines.begin(), cosines.end()}, streams, kOrders})
                .front();
        for (std::size_t i = 0; i < cosines.size(); ++i) {
            OrderShares shares;
            for (std::size_t n = 1; n < kOrders; ++n) {
                shares.transmitted[n] = slab.order[n].transmittance[i];
                shares.reflected[n] = slab.order[n].reflectance[i];
            }
            targets[i].depth.push_back(depth);
            targets[i].transmittance.push_back(slab.total.transmittance[i]);
            targets[i].shares.push_back(shares);
        }
    }
    const double g = medium.moment.size() > 1 ? medium.moment[1] : 0;
    std::vector<ColumnFit> fits(cosines.size());
    for (std::size_t i = 0; i < cosines.size(); ++i) {
        fits[i].model.length = kExtrapolation / (1 - g);
        fit_transmittance(targets[i], cosines[i], fits[i]);
        fit_orders(targets[i], cosines[i], fits[i]);
    }
    return fits;
}

}  // namespace opaline::bake
