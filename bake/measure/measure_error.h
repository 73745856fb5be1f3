#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/base/rng.h"

namespace opaline::bake {

/// Numerical error of the finished rows against the same model evaluated by brute force, over
/// held-back receivers and the published test lights; relative to the RMS of the reference
/// (design 7).
struct ErrorReport {
    double rms_relative = 0;
    double ci95[2] = {0, 0};  ///< of rms_relative: bootstrap over receivers, 2.5 and 97.5 percent
    double p95_relative = 0, max_relative = 0;
    std::uint32_t receivers_checked = 0;
    std::string reference;  ///< what it was measured against, in words
    struct Part {
        std::string name;
        double rms_relative = 0;
    };
    std::vector<Part> by_effect;  ///< pairs of one effect, over all lights
    std::vector<Part> by_light;   ///< pairs of one test light, over all effects
};

/// Luminance under each test light.
using Luminance = std::vector<double>;

/// Two independent unbiased estimates of the truth about one receiver.
struct TwoEstimates {
    Luminance first, second;
};

/// One receiver under one light: luminance. Two errors, against two independent estimates of the
/// truth: the mean of their products is that of the squared error, free of the estimates' noise.
/// Both are the same where the truth is known exactly.
struct CheckedPair {
    std::array<double, 2> error{};
    double reference = 0;
};

/// One pair for each light.
void append_pairs(const Luminance& found, const TwoEstimates& truth,
                  std::vector<CheckedPair>& pairs);

/// What one effect's check found: the pairs of each receiver stand together, one per light.
struct EffectCheck {
    std::string effect, reference;
    std::vector<CheckedPair> pairs;
    std::uint64_t rays = 0;
};

/// sqrt(mean of products of errors / mean square of the reference); 0 without a reference.
double relative_rms(std::span<const CheckedPair> pairs);

/// That, and the ends of its 95 % interval: bootstrap over receivers, the pairs of each standing
/// together, `lights` >= 1 of them.
struct ErrorBounds {
    double rms = 0, lowest = 0, highest = 0;
};
ErrorBounds bound_error(std::span<const CheckedPair> pairs, std::size_t lights, std::uint64_t seed);

/// The same as a file states it: its upper end allows for two more receivers that err as the worst
/// of these does. A plain bootstrap of 32 receivers contains the error of all in 80 of 100 cases
/// where shadows are sharp (tests/pipeline/coverage_test.cpp). `pairs` must not be empty.
ErrorBounds bound_stated_error(std::span<const CheckedPair> pairs, std::size_t lights,
                               std::uint64_t seed);

/// `wanted` of `count` indices, ascending, one from each of as many equal runs: spread over all
/// primitives, never twice the same. Drawn by (seed, stage).
std::vector<std::uint32_t> draw_evenly(std::size_t count, std::size_t wanted, RandomStage stage,
                                       std::uint64_t seed);

/// Receivers to check out of `count`, ascending: about one in forty, 32 to 1024, drawn by
/// (seed, draw) so that the check costs at most a tenth of the bake.
std::vector<std::uint32_t> draw_receivers(std::size_t count, std::uint64_t seed);

/// All effects together, each by itself, and each light by itself. Checks of one effect in several
/// materials count as one. `lights`: names, in the order of the pairs.
ErrorReport summarise_checks(std::span<const EffectCheck> checks,
                             std::span<const std::string> lights, std::uint64_t seed);

}  // namespace opaline::bake
