#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace opaline::bake {

/// Cosines by which random walks turn in place of a phase function: a Gauss rule, a few cosines
/// with positive chances that have its moments of degrees 0 to 2 n - 1. Light in harmonics of these
/// degrees is scattered as by the function itself, and no walk carries a sign or a weight.
struct TurnRule {
    static constexpr std::size_t kMost = 3;

    std::size_t count = 0;              ///< n, 1 to kMost; 0: no rule
    std::array<float, kMost> cosine{};  ///< ascending, in [-1, 1]
    std::array<float, kMost> below{};   ///< chance of a cosine up to this one; the last is 1
};

/// `lambda`: moments lambda_0 = 1, ..., lambda_5 of a function of the cosine that may be negative
/// somewhere, |lambda_1| <= 1. The most cosines that positive chances allow: of a function that is
/// not one of chances the moments of high degree may be those of none.
TurnRule make_turn_rule(std::span<const double, 2 * TurnRule::kMost> lambda);

}  // namespace opaline::bake
