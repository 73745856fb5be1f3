#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/opal/result.h"

namespace opaline::bake {

/// Accuracy presets: each names a set of knobs.
enum class Quality { draft, preview, production, reference };

inline constexpr std::uint32_t kAllCoefficients = 0xffffffffu;

/// What the user asked for. A zero means: as the quality says.
struct BakeOptions {
    Quality quality = Quality::preview;
    double error = 0;  ///< relative RMS that the finished file may err by, in [1e-4, 1): picks the
                       ///< knobs that are not given. 0: as the quality says
    std::uint32_t cubemap_size = 0;  ///< N: power of two in [8, 128]
    std::uint32_t coefficients = 0;  ///< M per row, the six face averages included; >= 7, or
                                     ///< kAllCoefficients
    std::uint32_t samples = 0;  ///< on the surface of each medium; 0: as its mean free path asks
                                ///< for, at most as many as the quality says
    double tolerance = -1;      ///< of the hierarchical gather, >= 0; negative: as the quality
                                ///< says
    std::uint32_t depth_samples = 0;  ///< of single scattering, along the inward normal
    std::uint32_t phase_terms = 0;    ///< K: 1, 4, 9, 16 or 25; 0: as the phase function asks for
    bool separate_terms = false;      ///< multiple scattering in a row of its own
    std::vector<std::string>
        effects;                ///< the only ones to simulate; empty: what the scene calls for
    bool simulate_all = false;  ///< every effect that concerns a material, however little it
                                ///< contributes, and no shortcut
    bool check_model = false;   ///< also measure the model's error against Monte Carlo
    std::uint64_t seed = 0;     ///< of everything random
    unsigned threads = 0;       ///< 0: one per core; never changes the result
};

/// What is going to be done: every knob has its value.
struct Knobs {
    Quality quality = Quality::preview;  ///< the preset that the others started from
    std::uint32_t cubemap_size = 16;
    std::uint32_t coefficients = 128;
    std::uint32_t code_bits = 8;    ///< of the stored detail coefficients
    std::uint32_t samples = 60000;  ///< on the surface of each medium
    bool exact_samples = false;     ///< otherwise `samples` is the most there may be
    double tolerance = 1e-3;        ///< GatherOptions::tolerance
    std::uint32_t depth_samples = 6;
    std::uint32_t phase_terms = 0;  ///< 0: chosen per medium
    double phase_tolerance = 0.02;  ///< by choose_terms (rules_single.h)
    bool exact_rays = false;        ///< no light maps, no rays shared between samples
    bool separate_terms = false;
    std::vector<std::string> effects;
    bool simulate_all = false;
    bool check_model = false;
    std::uint64_t seed = 0;

    /// Cube map that single scattering is gathered on. It is smooth, and each texel costs a render:
    /// 16 texels err by about .6 % of single scattering, which is a tenth of
    /// what a bright medium returns.
    std::uint32_t single_cubemap = 16;

    double samples_per_path = 1;  ///< surface samples per square of the depth of a medium's source
    double error_target = 0;      ///< 0: none; otherwise the pilot changes what is not fixed
    struct Fixed {
        bool cubemap = false, coefficients = false, tolerance = false, depth_samples = false;
    } fixed;  ///< given by the user
};

/// About as many as a file needs to err by `target` under the test lights: what a pilot starts
/// from.
std::uint32_t expected_coefficients(double target);

/// How many coefficients each surface sample and each cluster of them keeps. A row is a sum of
/// many: with half as many as the row has, from 1024 on, it errs hardly more, in half the memory.
std::uint32_t sample_coefficients(const Knobs& knobs);

/// Fills in the quality's values; refuses impossible ones (usage error).
formats::Result<Knobs> resolve_knobs(const BakeOptions& options);

std::string_view quality_name(Quality quality);

}  // namespace opaline::bake
