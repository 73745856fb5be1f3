#pragma once

#include <string_view>

#include "bake/plan/rates.h"

namespace opaline::tests {

/// Rates of no real machine: everything costs 10 ns, twice that on the larger of the two meshes.
inline bake::Rates make_rates() {
    bake::Rates rates;
    bake::visit_rates(rates, [](const char* name, double& rate) {
        const std::string_view text = name;
        rate = text.ends_with("_many") ? 2e-8 : 1e-8;
    });
    rates.crowding = 1.2;
    return rates;
}

}  // namespace opaline::tests
