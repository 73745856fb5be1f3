#include "bake/pilot/refinement.h"

#include <algorithm>

namespace opaline::bake {
namespace {

constexpr double kWorthIts = 0.9;  // error over that before
constexpr double kMostPerPath = 64;
constexpr std::uint32_t kMostSamples = 1000000;
constexpr std::uint32_t kLargestCubemap = 128;

bool has_finer_samples(const Refinement& refinement) {
    const Knobs& knobs = refinement.base->knobs;
    return refinement.more_samples_help && refinement.base->has_samples && !knobs.exact_samples &&
           knobs.samples_per_path < kMostPerPath && 2 * knobs.samples <= kMostSamples;
}

// A shadow's edge is as wide as a texel: its error falls by the same factor each time.
double least_error_of_texels(const Refinement& refinement) {
    double error = refinement.base->error;
    for (std::uint32_t n = refinement.base->knobs.cubemap_size; n < kLargestCubemap; n *= 2) {
        error *= refinement.texel_gain;
    }
    return error;
}

}  // namespace

bool learn(Refinement& refinement, const PilotRound& round) {
    if (refinement.base) {
        const PilotRound& base = *refinement.base;
        if (round.knobs.cubemap_size > base.knobs.cubemap_size) {
            refinement.texel_gain = base.error > 0 ? round.error / base.error : 1.0;
            refinement.more_texels_help = refinement.texel_gain <= kWorthIts;
            if (!refinement.more_texels_help) {
                return false;
            }
        } else if (round.smooth_error > kWorthIts * base.smooth_error) {
            refinement.more_samples_help = false;
            return false;
        }
    }
    refinement.base = round;
    return true;
}

std::optional<Knobs> next_knobs(const Refinement& refinement) {
    Knobs knobs = refinement.base->knobs;
    if (!knobs.fixed.coefficients) {
        knobs.coefficients = expected_coefficients(knobs.error_target);
    }
    const bool finer_samples = has_finer_samples(refinement);
    const bool finer_texels =
        refinement.more_texels_help && !knobs.fixed.cubemap && knobs.cubemap_size < kLargestCubemap;
    const bool is_smooth = refinement.base->smooth_error > 0.5 * knobs.error_target;
    if (finer_samples && (is_smooth || !finer_texels)) {
        knobs.samples_per_path *= 4;
        knobs.samples = std::min(4 * knobs.samples, kMostSamples);
        return knobs;
    }
    const bool in_reach =
        refinement.texel_gain == 0 || least_error_of_texels(refinement) <= knobs.error_target;
    if (finer_texels && in_reach) {
        knobs.cubemap_size *= 2;
        return knobs;
    }
    return std::nullopt;
}

}  // namespace opaline::bake
