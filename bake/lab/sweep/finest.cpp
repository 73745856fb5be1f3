#include "bake/lab/sweep/finest.h"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "bake/base/stage_log.h"
#include "bake/lab/sweep/run_sweep.h"

namespace opaline::bake {
namespace {

// What fills the rows of each material: "multiple+single".
std::vector<std::string> name_row_effects(const SweepResult& result, const EffectTable& effects,
                                          const formats::Scene& scene) {
    std::vector<std::string> names(scene.materials.size());
    for (std::uint32_t m = 0; m < names.size(); ++m) {
        const auto decisions = entries_of(result.plan, m);
        for (const EffectDescriptor& effect : effects.effects) {
            if (effect.truth.make != nullptr && acts_on(effect, decisions, {})) {
                names[m] += (names[m].empty() ? "" : "+") + std::string(effect.name);
            }
        }
    }
    return names;
}

// `trace` with a context that stops it.
template <class Trace>
auto trace_at_most(double seconds, const Context& context, Trace&& trace) {
    const TimeLimit limit(seconds, context.cancel);
    Context limited = context;
    limited.cancel = limit.flag();
    return trace(limited);
}

// Path tracing that the total error of every bake is measured against: few at first, and more as
// long as the time allows; the least amount is traced whatever it takes. Once cancelled, what was
// traced by then. Errors: as trace_model_truth, if that is nothing.
formats::Result<std::vector<LightCheck>> trace_for(const formats::Scene& scene,
                                                   const ModelProbes& probes,
                                                   ModelCheckOptions wanted, double seconds,
                                                   const Context& context) {
    constexpr std::uint64_t kFewEvents = 20000, kMostEvents = 300000000;  // for each light
    constexpr double kMostTimes = 16;  // the time of few events predicts that of many badly
    wanted.max_events = kFewEvents;
    std::vector<LightCheck> fewer;  // of the round before
    for (double left = seconds;;) {
        const Clock::time_point start = Clock::now();
        auto traced = trace_model_truth(scene, probes, wanted, context);
        if (!traced && traced.error().kind == formats::ErrorKind::interrupted && !fewer.empty()) {
            return fewer;
        }
        const double took = std::max(seconds_since(start), 1e-3);
        left -= took;
        const double times = std::min(left / took, kMostTimes);
        if (!traced || times < 2 || wanted.max_events >= kMostEvents) return traced;
        fewer = std::move(*traced);
        wanted.max_events =
            std::min(kMostEvents,
                     static_cast<std::uint64_t>(times * static_cast<double>(wanted.max_events)));
    }
}

}  // namespace

std::size_t find_finest(std::span<const PointRecord> points, std::string_view choices) {
    const auto worth = [&](const PointRecord& p) {
        return std::tuple{p.choices != choices, p.error.rms_relative, -p.seconds};
    };
    const auto finest = std::ranges::min_element(points, {}, worth);
    return static_cast<std::size_t>(finest - points.begin());
}

void compare_with_finest(SweepResult& result, const EffectTable& effects,
                         const formats::Scene& scene, std::span<const std::uint32_t> probes,
                         std::span<const std::string> lights) {
    const std::vector<std::string> of_material = name_row_effects(result, effects, scene);
    std::vector<std::uint32_t> material;
    for (const formats::Primitive& p : scene.primitives) {
        material.insert(material.end(), p.position.size(), p.material);
    }
    std::vector<std::string> effect;
    for (const std::uint32_t probe : probes) {
        effect.push_back(of_material[material[probe]]);
    }
    std::map<std::string, std::size_t> count;
    for (PointRecord& record : result.points) {
        record.finest = find_finest(result.points, record.choices);
        ++count[record.choices];
    }
    const auto most = std::ranges::max_element(
        count, {}, [](const auto& choices_and_points) { return choices_and_points.second; });
    result.truth = find_finest(result.points, most->first);
    for (PointRecord& record : result.points) {
        const PointRecord& finest = result.points[record.finest];
        record.against_finest = compare_probes(record.luminance, finest.luminance, effect, lights);
        if (!record.volume_luminance.empty()) {
            const std::vector<std::string> of_volumes(record.volume_luminance.size() / kLightPlaces,
                                                      "volumes");
            take_larger(record.against_finest,
                        compare_probes(record.volume_luminance, finest.volume_luminance, of_volumes,
                                       volume_light_names()));
        }
        if (!record.layer_radiance.empty()) {
            const std::vector<std::string> of_layers(record.layer_radiance.size(), "cloud");
            const std::string light[] = {"layers"};
            take_larger(
                record.against_finest,
                compare_probes(record.layer_radiance, finest.layer_radiance, of_layers, light));
        }
        add_error_of_truth(record.against_finest, finest.error);
    }
}

formats::Result<SweepTruths> trace_truths(const formats::Scene& scene, const ModelProbes& probes,
                                          const ModelCheckOptions& options, double seconds,
                                          double left, const Context& context) {
    const Clock::time_point start = Clock::now();
    SweepTruths truths;
    const double half = std::max(0.0, 0.5 * left);
    auto reference = trace_at_most(half, context, [&](const Context& limited) {
        return climb_reference(
            scene, {.seconds = seconds, .most_seconds = half, .seed = options.seed}, limited);
    });
    if (reference) {
        truths.reference = std::move(*reference);
    } else if (reference.error().kind != formats::ErrorKind::interrupted) {
        return std::move(reference).error();
    }
    if (!truths.reference) {
        truths.left_out.push_back({"ladder of the Monte Carlo reference",
                                   "no light reaches the receivers, or its first rungs would take "
                                   "more than half of the time that was left"});
    }
    auto traced =
        trace_at_most(0.5 * (left - seconds_since(start)), context, [&](const Context& limited) {
            return trace_for(scene, probes, options, seconds, limited);
        });
    if (traced) {
        truths.traced = std::move(*traced);
    } else if (traced.error().kind != formats::ErrorKind::interrupted) {
        return std::move(traced).error();
    } else {
        truths.left_out.push_back({"total error",
                                   "the path tracing that it is measured against was not done in "
                                   "half of the time that was left"});
    }
    return truths;
}

}  // namespace opaline::bake
