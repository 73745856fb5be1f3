#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bake/effects/rows/subject_states.h"
#include "bake/effects/volumes/complete_rows.h"
#include "bake/lights/luminance.h"
#include "bake/lights/test_lights.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

/// Relative RMS of some points under the published test lights: RMS of the error over RMS of the
/// reference.
struct MeasuredError {
    double rms_relative = 0;
    double ci95[2] = {0, 0};  ///< of rms_relative: bootstrap over points, 2.5 and 97.5 percent
    struct Part {
        std::string name;
        double rms_relative = 0;
    };
    std::vector<Part> by_effect;  ///< pairs of one effect, over all lights
    std::vector<Part> by_light;   ///< pairs of one test light, over all effects
};

/// Numerical error of the finished file against the same model evaluated by brute force (design 7):
/// at held-back receivers, between receivers, and over both together.
struct ErrorReport : MeasuredError {
    double p95_relative = 0, max_relative = 0;
    std::uint32_t receivers_checked = 0;
    std::uint32_t points_between_checked = 0;
    std::string reference;  ///< the reference, in words
    MeasuredError at_receivers;
    MeasuredError between;  ///< at random points of the surface, mixed as the runtime does
    /// Primitive with the largest part of the squared error between receivers.
    std::uint32_t worst_between = 0;
    std::vector<std::string> not_measured;  ///< effects of the file that the check does not see

    /// What a check of its own found at so many places; none: it is not measured.
    void add_part(std::string name, std::uint32_t checked, double rms) {
        if (checked > 0) {
            by_effect.push_back({std::move(name), rms});
        } else {
            not_measured.push_back(std::move(name));
        }
    }
};

/// One receiver under one light: luminance, and its errors against two independent estimates of the
/// truth. The mean product of the two errors estimates the squared error without the noise of the
/// estimates. The two are equal where the truth is exact.
struct CheckedPair {
    std::array<double, 2> error{};
    double reference = 0;
};

/// One pair for each light.
void append_pairs(const Luminance& found, const TwoEstimates& truth,
                  std::vector<CheckedPair>& pairs);

/// Result of one effect's check: the pairs of a point are consecutive, one per light.
struct EffectCheck {
    std::string effect, reference;
    std::vector<CheckedPair> pairs;
    std::vector<std::uint32_t> primitive;  ///< of each point; may be empty
    std::uint64_t rays = 0;
    bool between = false;  ///< at points between receivers
};

/// One point's share of a check: no pairs where the check does not concern it.
struct CheckedPoint {
    std::uint32_t primitive = 0;
    std::vector<CheckedPair> pairs;
    std::uint64_t rays = 0;
};
void append_point(const CheckedPoint& point, EffectCheck& check);

/// sqrt(mean of products of errors / mean square of the reference); 0 without a reference.
double relative_rms(std::span<const CheckedPair> pairs);

/// The same with the ends of its 95 % interval by bootstrap over receivers; each receiver has
/// `lights` consecutive pairs; without lights there are no pairs, and the error is 0.
struct ErrorBounds {
    double rms = 0, lowest = 0, highest = 0;
};
ErrorBounds bound_error(std::span<const CheckedPair> pairs, std::size_t lights, std::uint64_t seed);

/// The same as a file states it: its upper end allows for two more receivers that err as the worst
/// of these does. A plain bootstrap of 32 receivers contains the error of all in 80 of 100 cases
/// where shadows are sharp (tests/pipeline/holes_test.cpp). `pairs` must not be empty.
ErrorBounds bound_stated_error(std::span<const CheckedPair> pairs, std::size_t lights,
                               std::uint64_t seed);

/// All effects together, each by itself, and each light by itself; at receivers, between them, and
/// over both. Checks of one effect in several materials count as one. `lights`: names, in the
/// order of the pairs.
ErrorReport summarise_checks(std::span<const EffectCheck> checks,
                             std::span<const std::string> lights, std::uint64_t seed);

/// What a finished file was baked from.
struct FinishedBake {
    const BakeInputs& inputs;
    std::span<const SubjectState> subjects;
    const Knobs& knobs;
    std::span<const TestLight> lights;       ///< of the asset's cube map
    const VolumesBefore* volumes = nullptr;  ///< that completed its rows; null: none
};

/// Compares the file with the truth, without base colour, at held-back receivers and at as many
/// random points of the surface, where the file is interpolated as the runtime does: each subject's
/// rows as a whole, under the lights as they are. Seen along the normal; where walks hold light of
/// all orders, a quarter of the points so and the others from elsewhere (turn_views). Volumes dim
/// the truth's light on its way to the surface; what they scatter is that of the file's nodes, by
/// other rays. `traced` adds up.
ErrorReport check_file(const FinishedBake& bake, const formats::AssetView& asset,
                       const Context& context, std::uint64_t& traced);

}  // namespace opaline::bake
