#include "bake/accuracy/pilot/choose_encoding.h"

#include <algorithm>
#include <numbers>

namespace opaline::bake {
namespace {

// More coefficients are taken only if they lower the error by this ratio.
constexpr double kHardlyMore = 1.05;

// A 95 % interval is four of them wide.
double standard_error(const ErrorBounds& bounds) {
    return 0.25 * (bounds.highest - bounds.lowest);
}

}  // namespace

double likely_error(const ErrorBounds& bounds) {
    return bounds.rms + standard_error(bounds);
}

double sure_error(const ErrorBounds& bounds) {
    return bounds.rms + 2 * std::numbers::sqrt2 * standard_error(bounds);
}

std::size_t choose_encoding(std::span<const ErrorBounds> errors, double target) {
    const double surest = sure_error(*std::ranges::min_element(errors, {}, sure_error));
    const double enough = surest <= target ? target : kHardlyMore * surest;
    auto chosen =
        std::ranges::find_if(errors, [&](const auto& b) { return !(sure_error(b) > enough); });
    if (likely_error(*chosen) > target) {
        const auto likely =
            std::ranges::find_if(errors, [&](const auto& b) { return likely_error(b) <= target; });
        chosen = likely != errors.end() ? likely : chosen;
    }
    return static_cast<std::size_t>(chosen - errors.begin());
}

}  // namespace opaline::bake
