#pragma once

namespace opaline::bake {

/// Shares of a beam's flux that leave a slab of albedo 1, by order: index 0, 1 and 2, then 3 for
/// all orders after these.
struct OrderShares {
    double transmitted[4] = {1, 0, 0, 0};
    double reflected[4] = {0, 0, 0, 0};
};

/// Fills in order 0 and the orders from 3 on, so that all shares add up to 1. `straight` = T_0 and
/// `transmittance` = T_0 + T_1 + ..., both in [0, 1]. Orders 1 and 2 of `shares` may come from a
/// model that knows nothing of the others: where they exceed what is left to them, they shrink to
/// it.
OrderShares complete_shares(OrderShares shares, double straight, double transmittance);

}  // namespace opaline::bake
