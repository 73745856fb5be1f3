#include "bake/cli/view/coefficient_error.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "runtime/shade.h"

namespace opaline::cli {
namespace {

double squared_norm(formats::Rgb c) {
    const double r = static_cast<double>(c.r), g = static_cast<double>(c.g),
                 b = static_cast<double>(c.b);
    return r * r + g * g + b * b;
}

}  // namespace

double coefficient_error_of(const formats::AssetView& whole, const formats::AssetView& shortened,
                            const runtime::PartLights& light, formats::TermSet terms) {
    constexpr std::uint32_t kMost = 4096;
    const std::uint32_t step = std::max(1u, (whole.receivers() + kMost - 1) / kMost);
    runtime::ShadeOptions options;
    options.terms = terms;
    double difference = 0, sum = 0;
    for (std::uint32_t receiver = 0; receiver < whole.receivers(); receiver += step) {
        formats::Rgb all, few;
        runtime::shade_range(whole, light, receiver, {&all, 1}, options);
        runtime::shade_range(shortened, light, receiver, {&few, 1}, options);
        difference += squared_norm(all + -1.0f * few);
        sum += squared_norm(all);
    }
    return sum > 0 ? std::sqrt(difference / sum) : 0;
}

}  // namespace opaline::cli
