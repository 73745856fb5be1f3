#include "bake/slab/order_shares.h"

#include <algorithm>

namespace opaline::bake {
namespace {

/// Shrinks two shares to a sum of `most` at most; returns what they leave of it.
double leave_rest(double& first, double& second, double most) {
    const double sum = first + second;
    if (sum <= most) {
        return most - sum;
    }
    const double scale = std::max(most, 0.0) / sum;
    first *= scale;
    second *= scale;
    return 0;
}

}  // namespace

OrderShares complete_shares(OrderShares shares, double straight, double transmittance) {
    const double all = std::clamp(transmittance, straight, 1.0);
    shares.transmitted[0] = straight;
    shares.transmitted[3] =
        leave_rest(shares.transmitted[1], shares.transmitted[2], all - straight);
    shares.reflected[3] = leave_rest(shares.reflected[1], shares.reflected[2], 1 - all);
    return shares;
}

}  // namespace opaline::bake
