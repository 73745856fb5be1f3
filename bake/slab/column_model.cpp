#include "bake/slab/column_model.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace opaline::bake {
namespace {

/// y - 1 + e^-y for y >= 0: y^2 / 2 - y^3 / 6 + ...
double twice_turned(double y) {
    constexpr double kSeriesBelow = 0.2;
    if (y >= kSeriesBelow) {
        return y + std::expm1(-y);
    }
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

}  // namespace opaline::bake
