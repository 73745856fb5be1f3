#include "bake/check/pilot/refinement.h"

#include <algorithm>

namespace opaline::bake {
namespace {

constexpr double kWorthIts = 0.9;  // ratio of errors after and before
constexpr std::uint32_t kLargestCubemap = 128;

// The knobs with finer samples of all effects that have some; nothing: none can be finer.
std::optional<Knobs> refine_samples(const EffectTable& effects, const Refinement& refinement,
                                    Knobs knobs) {
    if (!refinement.more_samples_help || !refinement.base->has_samples) return std::nullopt;
    bool is_finer = false;
    for (const EffectDescriptor& effect : effects.effects) {
        is_finer = (effect.samples.refine != nullptr && effect.samples.refine(knobs)) || is_finer;
    }
    return is_finer ? std::optional(std::move(knobs)) : std::nullopt;
}

// A shadow edge is as wide as a texel, so its error falls by the same factor each time.
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
            if (!refinement.more_texels_help) return false;
        } else if (round.smooth_error > kWorthIts * base.smooth_error) {
            refinement.more_samples_help = false;
            return false;
        }
    }
    refinement.base = round;
    return true;
}

std::optional<Knobs> next_knobs(const EffectTable& effects, const Refinement& refinement) {
    Knobs knobs = refinement.base->knobs;
    if (!knobs.coefficients_given) {
        knobs.coefficients = expected_coefficients(knobs.numerical_target());
    }
    const std::optional<Knobs> finer_samples = refine_samples(effects, refinement, knobs);
    const bool finer_texels =
        refinement.more_texels_help && !knobs.cubemap_given && knobs.cubemap_size < kLargestCubemap;
    const bool is_smooth = refinement.base->smooth_error > 0.5 * knobs.numerical_target();
    if (finer_samples && (is_smooth || !finer_texels)) return finer_samples;
    const bool in_reach =
        refinement.texel_gain == 0 || least_error_of_texels(refinement) <= knobs.numerical_target();
    if (finer_texels && in_reach) {
        knobs.cubemap_size *= 2;
        return knobs;
    }
    return std::nullopt;
}

}  // namespace opaline::bake
