#include "bake/pilot/pilot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/pilot/choose_encoding.h"
#include "bake/pilot/opaque_pairs.h"
#include "bake/pilot/pilot_rows.h"

namespace opaline::bake {
namespace {

// Parts of the target's square that the tolerance and the single scattering's samples may take;
// what is left is for coefficients, which cost most bytes.
constexpr double kShareOfTolerance = 0.1, kShareOfSingle = 0.1;

constexpr std::array<double, 5> kTolerances{1e-2, 3e-3, 1e-3, 3e-4, 1e-4};
constexpr double kFinestTolerance = 3e-5;
struct SingleLevel {
    std::uint32_t depth_samples, cubemap;
};
constexpr std::array<SingleLevel, 3> kSingleLevels{{{4, 8}, {6, 16}, {10, 16}}};

double square_error(std::span<const CheckedPair> pairs) {
    const double rms = relative_rms(pairs);
    return rms * rms;
}

// Pairs of the lights without suns alone.
std::vector<CheckedPair> without_suns(std::span<const CheckedPair> pairs,
                                      std::span<const TestLight> lights) {
    std::vector<CheckedPair> smooth;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (lights[i % lights.size()].discs.empty()) {
            smooth.push_back(pairs[i]);
        }
    }
    return smooth;
}

// All that trying a knob takes.
struct Trials {
    const PilotScene& pilot;
    std::span<const PilotReceiver> receivers;  ///< all
    const OpaquePairs& opaque;
    const MediaStages& media;
    std::span<const TestLight> lights;
    const Context& context;
    double target;
    std::vector<PilotReceiver> in_media{};
    PilotChoice choice{};
    PilotSingles single{};  ///< of those in media

    std::vector<std::vector<CheckedPair>> measure(const RowSetting& setting,
                                                  std::span<const Encoding> encodings) const {
        auto pairs = measure_rows(pilot, in_media, media, single, setting,
                                  choice.knobs.cubemap_size, encodings, lights, context);
        for (std::size_t e = 0; e < encodings.size(); ++e) {
            pairs[e] =
                insert_opaque(pilot, receivers, pairs[e], opaque, encodings[e], lights.size());
        }
        return pairs;
    }
    // With all coefficients.
    std::vector<CheckedPair> measure(const RowSetting& setting) const {
        return measure(setting, std::array{kUnencoded}).front();
    }
    void note(const char* knob, double value, double square) {
        choice.trials.push_back({knob, value, std::sqrt(square), 16});
    }

    bool has_multiple() const {
        return std::any_of(media.begin(), media.end(),
                           [](const auto& m) { return m.second.multiple.has_value(); });
    }

    void choose_tolerance(RowSetting& setting, double floor) {
        for (const double tolerance : kTolerances) {
            RowSetting coarse = setting;
            coarse.tolerance = tolerance;
            const double square = square_error(measure(coarse));
            note("epsilon", tolerance, square);
            if (square <= floor + kShareOfTolerance * target * target) {
                setting.tolerance = tolerance;
                return;
            }
        }
    }

    void choose_single(RowSetting& setting, double floor) {
        PilotSingles finest = std::move(single);
        for (const SingleLevel& level : kSingleLevels) {
            if (level.depth_samples >= setting.depth_samples) {
                break;
            }
            // Never finer than the asset's own cube map.
            const RowSetting coarse{setting.tolerance, level.depth_samples,
                                    std::min(level.cubemap, choice.knobs.cubemap_size)};
            single = gather_pilot_single(pilot, in_media, coarse, context);
            const double square = square_error(measure(coarse));
            note("depth_samples", level.depth_samples, square);
            if (square <= floor + kShareOfSingle * target * target) {
                setting = coarse;
                return;
            }
        }
        single = std::move(finest);
    }

    void choose_coefficients(const RowSetting& setting) {
        const Knobs& knobs = choice.knobs;
        const std::vector<Encoding> encodings = list_encodings(knobs);
        const auto pairs = measure(setting, encodings);
        if (context.cancelled()) {
            return;
        }
        std::vector<ErrorBounds> errors;
        bool is_sure = false;
        for (std::size_t e = 0; e < encodings.size() && !is_sure; ++e) {
            errors.push_back(bound_error(pairs[e], lights.size(), knobs.seed));
            choice.trials.push_back({"coefficients", static_cast<double>(encodings[e].coefficients),
                                     errors[e].rms, encodings[e].code_bits});
            is_sure = sure_error(errors[e]) <= target;
        }
        const std::size_t chosen = choose_encoding(errors, target);
        choice.knobs.coefficients = encodings[chosen].coefficients;
        choice.knobs.code_bits = encodings[chosen].code_bits;
        choice.error = errors[chosen].rms;
        choice.likely = likely_error(errors[chosen]);
        choice.met = choice.likely <= target;
    }
};

}  // namespace

PilotChoice choose_row_knobs(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                             const OpaquePairs& opaque, const Knobs& knobs,
                             const MediaStages& media, std::span<const TestLight> lights,
                             const Context& context) {
    Trials trials{pilot, receivers, opaque, media, lights, context, knobs.error_target};
    std::copy_if(receivers.begin(), receivers.end(), std::back_inserter(trials.in_media),
                 [&](const PilotReceiver& r) { return pilot.layouts[r.material].translucent; });
    trials.choice.knobs = knobs;
    RowSetting setting{
        knobs.fixed.tolerance ? knobs.tolerance : kFinestTolerance,
        knobs.fixed.depth_samples ? knobs.depth_samples : kSingleLevels.back().depth_samples,
        std::min(kSingleLevels.back().cubemap, knobs.cubemap_size)};
    trials.single = gather_pilot_single(pilot, trials.in_media, setting, context);
    const std::vector<CheckedPair> finest = trials.measure(setting);
    const double floor = square_error(finest);
    trials.choice.finest_error = std::sqrt(floor);
    trials.choice.smooth_error = relative_rms(without_suns(finest, lights));
    if (trials.has_multiple() && !knobs.fixed.tolerance) {
        trials.choose_tolerance(setting, floor);
    }
    if (!trials.single.empty() && !knobs.fixed.depth_samples) {
        trials.choose_single(setting, floor + kShareOfTolerance * trials.target * trials.target);
    }
    trials.choice.knobs.tolerance = setting.tolerance;
    trials.choice.knobs.depth_samples = setting.depth_samples;
    trials.choice.knobs.single_cubemap = setting.single_cubemap;
    trials.choose_coefficients(setting);
    return std::move(trials.choice);
}

}  // namespace opaline::bake
