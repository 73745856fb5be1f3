#include "bake/lab/sweep/run_sweep.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <new>
#include <optional>
#include <utility>

#include "bake/base/interrupted.h"
#include "bake/base/ordered_parallel.h"
#include "bake/base/stage_log.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/lab/sweep/finest.h"
#include "bake/lab/sweep/run_point.h"
#include "bake/lights/builtin_environment.h"
#include "bake/pipeline/cost_model.h"
#include "bake/pipeline/plan_scene.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

// Of the time, for what all bakes are compared with.
constexpr double kShare = 1.0 / 20;

formats::Error make_time_error(std::string fault) {
    return formats::make_error(formats::ErrorKind::usage, "", "--seconds", std::move(fault),
                               "give more seconds, or a smaller scene");
}

std::string amount(double value, const char* unit) {
    char text[48];
    std::snprintf(text, sizeof text, value < 10 ? "%.1f %s" : "%.0f %s", value, unit);
    return text;
}

// There is something that path tracing and test lights are for: a layer alone has neither.
bool has_receivers(const formats::Scene& scene) {
    return !scene.primitives.empty() || !scene.volumes.empty();
}

// The state of a sweep in progress.
struct Sweep {
    const EffectTable& effects;
    const formats::Scene& scene;
    const SceneFacts& facts;
    const SweepOptions& options;
    const Context& context;  ///< cancelled once the time is over
    const Context& outer;    ///< as the caller gave it
    const std::function<void(const SweepStep&)>& on_step;
    Clock::time_point start;
    SweepResult result{};
    SweepView view{};
    std::map<std::uint32_t, SweepLights> lights{};  // by cube map size
    std::size_t total = 1;
    double measured = 0, predicted = 0;  // of the points so far

    CostPrediction predict_point(const Knobs& knobs) const {
        std::vector<PlanEntry> plan = result.plan;
        replace_entries(Subject::Kind::material, plan_bake(effects, scene, facts, knobs), plan);
        return predict_costs({effects, scene, facts, knobs, options.rates, context.threads}, plan);
    }
    LadderRequest ladder_request() const {
        return {effects, result.subject, options.bake, list_choices(result.plan)};
    }

    double left() const { return options.seconds - seconds_since(start); }
    // Predictions are right within a factor of two, and the factor is the same for all points on a
    // machine.
    double scale() const { return predicted > 0 ? measured / predicted : 1.0; }

    bool is_out_of_time(const formats::Error& error) const {
        return error.kind == formats::ErrorKind::interrupted && !outer.cancelled();
    }

    // Why a point is skipped; empty: it is not.
    std::string objection(const CostPrediction& cost, double seconds_left) const {
        if (const auto bytes = static_cast<double>(cost.bytes); bytes > options.most_bytes) {
            return "the file would be " + amount(bytes * 1e-9, "GB");
        }
        const double seconds = cost.seconds * scale();
        if (seconds_left <= 0) return "no time was left for its " + amount(seconds, "s");
        if (seconds > seconds_left) {
            return "would take about " + amount(seconds, "s") + ", more than the " +
                   amount(seconds_left, "s") + " left for it";
        }
        return {};
    }

    // None where nothing is relit.
    formats::Result<const SweepLights*> lights_of(std::uint32_t n) {
        auto known = lights.find(n);
        if (known == lights.end()) {
            auto probes = has_receivers(scene) ? make_probe_lights(n, context.threads)
                                               : formats::Result<ProbeLights>(ProbeLights{});
            if (!probes) return std::move(probes).error();
            SweepLights made{std::move(*probes), {}};
            for (const ModelLight& light : view.model.lights) {
                made.model.push_back(
                    runtime::project_environment(light.environment, n, {}, context.threads));
            }
            known = lights.emplace(n, std::move(made)).first;
        }
        return &known->second;
    }

    // A point that differs only in automatic choices, and made the same ones.
    PointRecord* find_chosen(const SweepPoint& point) {
        for (const Rung& rung : point.rungs) {
            if (rung.ladder.knob == nullptr || rung.ladder.knob->words.empty()) continue;
            const KnobSpec& knob = *rung.ladder.knob;
            for (PointRecord& record : result.points) {
                Knobs given = record.point.knobs;
                given.set(knob, rung.value);
                if (record.choices == knob.words[static_cast<std::size_t>(rung.value)] &&
                    same_bake(given, point.knobs, result.subject)) {
                    return &record;
                }
            }
        }
        return nullptr;
    }

    void skip(const SweepPoint& point, const CostPrediction& cost, std::string reason) {
        result.skipped.push_back(
            {point, cost.seconds * scale(), static_cast<double>(cost.bytes), std::move(reason)});
    }

    // Bakes a point, or notes why not. A choice that an automatic one made as well is not baked
    // again.
    formats::Status visit(const SweepPoint& point, double seconds_left) {
        if (PointRecord* same = find_chosen(point)) {
            same->point.rungs.insert(same->point.rungs.end(), point.rungs.begin(),
                                     point.rungs.end());
            --total;
            return formats::ok_status();
        }
        const CostPrediction cost = predict_point(point.knobs);
        if (std::string reason = objection(cost, seconds_left); !reason.empty()) {
            skip(point, cost, std::move(reason));
            return formats::ok_status();
        }
        if (on_step) {
            on_step({result.points.size() + result.skipped.size(), total, point.label});
        }
        const auto point_lights = lights_of(point.knobs.cubemap_size);
        if (!point_lights) return point_lights.error();
        try {
            auto record = run_point(effects, scene, point, view, **point_lights, context);
            if (!record && is_out_of_time(record.error())) {
                skip(point, cost, "was not done in the time that was left");
                return formats::ok_status();
            }
            if (!record) return std::move(record).error();
            measured += record->seconds;
            predicted += cost.seconds;
            result.points.push_back(std::move(*record));
        } catch (const std::bad_alloc&) {
            skip(point, cost, "there is not enough memory");
        }
        return formats::ok_status();
    }
};

// The finest candidate that half of the time that is left allows.
std::optional<SweepPoint> choose_truth(const Sweep& sweep) {
    for (const SweepPoint& candidate : make_truths(sweep.ladder_request())) {
        const CostPrediction cost = sweep.predict_point(candidate.knobs);
        if (sweep.objection(cost, 0.5 * sweep.left()).empty()) return candidate;
    }
    return std::nullopt;
}

// Bakes the finest setting that can be afforded. A point of the ladders keeps its label and rungs,
// and leaves them.
formats::Status bake_truth(Sweep& sweep, std::vector<SweepPoint>& points) {
    const auto truth = choose_truth(sweep);
    if (!truth) return formats::ok_status();
    const auto same = std::find_if(points.begin(), points.end(), [&](const SweepPoint& p) {
        return same_bake(p.knobs, truth->knobs, sweep.result.subject);
    });
    const SweepPoint point = same == points.end() ? *truth : *same;
    if (same == points.end()) {
        ++sweep.total;
    } else {
        points.erase(same);
    }
    return sweep.visit(point, sweep.left());
}

}  // namespace

TimeLimit::TimeLimit(double seconds, const std::atomic<bool>* outer)
    : watch_([this, seconds, outer, start = Clock::now()](const std::stop_token& stop) {
          constexpr std::chrono::milliseconds kLook{10};
          std::unique_lock lock(mutex_);
          while (!stop.stop_requested()) {
              if (seconds_since(start) >= seconds || (outer != nullptr && outer->load())) {
                  over_.store(true);
                  return;
              }
              wake_.wait_for(lock, stop, kLook, [] { return false; });
          }
      }) {}

formats::Result<SweepResult> run_sweep(const EffectTable& effects, const formats::Scene& scene,
                                       const SweepOptions& options, const Context& outer,
                                       const std::function<void(const SweepStep&)>& on_step) {
    const Clock::time_point start = Clock::now();
    const TimeLimit limit(options.seconds, outer.cancel);
    Context context = outer;
    context.threads = thread_count(outer);
    context.cancel = limit.flag();
    context.on_progress = {};  // steps are the progress
    auto picture_light = open_environment(options.light);
    if (!picture_light) return std::move(picture_light).error();
    BakeOptions base = options.bake;
    base.quality = Quality::draft;
    const auto draft = resolve_knobs(effects, base);
    base.quality = Quality::preview;
    const auto preview = resolve_knobs(effects, base);
    if (!draft || !preview) return (draft ? preview : draft).error();
    const ScenePlan planned = plan_scene(effects, scene, {}, *preview);
    Sweep sweep{.effects = effects,
                .scene = scene,
                .facts = planned.facts,
                .options = options,
                .context = context,
                .outer = outer,
                .on_step = on_step,
                .start = start};
    SweepResult& result = sweep.result;
    result.source = std::filesystem::path(scene.source).filename().string();
    result.sha256 = scene.sha256;
    result.threads = context.threads;
    result.seed = options.bake.seed;
    result.picture_light = options.light;
    result.plan = planned.entries;
    for (const formats::Primitive& p : scene.primitives) {
        result.receivers += p.position.size();
        result.triangles += p.index.size() / 3;
        const auto& medium = scene.materials[p.material].medium;
        if (medium && result.mean_cosine == 0) {
            result.mean_cosine = formats::mean_cosine(medium->phase);
        }
    }
    if (!scene.volumes.empty() && result.mean_cosine == 0) {
        result.mean_cosine = formats::mean_cosine(scene.volumes.front().phase);
    }
    sweep.view.probes = choose_probes(result.receivers, options.probes);
    sweep.view.picture_light = std::move(picture_light->environment);
    if (has_receivers(scene)) {
        constexpr std::uint32_t kModelReceivers = 96;
        auto model = choose_model_probes(scene, kModelReceivers, options.bake.seed, context);
        if (!model) return std::move(model).error();
        sweep.view.model = std::move(*model);
    }
    result.subject = sweep_subject(effects, scene, result.plan, *preview);
    if (result.subject.has_volumes) {
        auto volumes =
            make_sweep_volumes(scene, kShare * options.seconds, options.bake.seed, context);
        if (!volumes && sweep.is_out_of_time(volumes.error())) {
            return make_time_error("it is over before a first look at the light of the volumes");
        }
        if (!volumes) return std::move(volumes).error();
        sweep.view.volumes = std::move(*volumes);
    }
    // A quick point measures the speed of this machine.
    const SweepPoint first{
        std::string(quality_name(Quality::draft)), {{Ladders::preset, 0}}, *draft};
    if (auto status = sweep.visit(first, sweep.left()); !status) return std::move(status).error();
    if (result.points.empty()) {
        return make_time_error("not even a draft fits: it " + result.skipped.front().reason);
    }
    SweepTruths truths;
    if (has_receivers(scene)) {
        auto found = trace_truths(scene, sweep.view.model,
                                  {.seed = options.bake.seed,
                                   .simulated = held_light(effects, result.plan),
                                   .lit_by_volumes = lights_surfaces(result.plan),
                                   .volumes_see_surfaces = sees_surfaces(result.plan)},
                                  kShare * options.seconds, sweep.left(), context);
        if (!found) return std::move(found).error();
        truths = std::move(*found);
        result.reference = std::move(truths.reference);
        for (SweepTruths::LeftOut& left : truths.left_out) {
            result.skipped.push_back(
                {{std::move(left.name), {}, {}}, 0, 0, std::move(left.reason)});
        }
    }
    if (sweep.predict_point(*preview).seconds * sweep.scale() > kShare * options.seconds) {
        result.base = Quality::draft;
        result.plan = plan_scene(effects, scene, {}, *draft).entries;
    }
    std::vector<SweepPoint> points = make_ladders(sweep.ladder_request(), result.base);
    result.points.front().point = points.front();  // with the rungs of a base, if it is one
    points.erase(points.begin());
    sweep.total = 1 + points.size();
    if (auto status = bake_truth(sweep, points); !status) return std::move(status).error();
    order_points(points,
                 [&](const SweepPoint& point) { return sweep.predict_point(point.knobs).seconds; });
    for (const SweepPoint& point : points) {
        // One preset or choice must not take the time of all ladders.
        const double share = urgency(point) <= 1 ? 0.5 : 1.0;
        if (auto status = sweep.visit(point, share * sweep.left()); !status) {
            return std::move(status).error();
        }
    }
    if (outer.cancelled()) return interrupted();
    scale_layer_radiance(result.points);
    const std::vector<std::string>& names = sweep.lights.begin()->second.probes.names;
    compare_with_finest(result, effects, scene, sweep.view.probes, names);
    if (result.subject.has_surfaces) {
        result.lights = names;
    }
    if (!sweep.view.volumes.empty()) {
        std::ranges::copy(volume_light_names(), std::back_inserter(result.lights));
    }
    for (PointRecord& record : result.points) {
        if (!truths.traced.empty()) {
            record.total = compare_with_truth(record.model_luminance, truths.traced,
                                              sweep.view.model, options.bake.seed);
        }
        if (!record.volume_luminance.empty()) {
            take_larger(record.total, record.volumes);
        }
    }
    result.seconds = seconds_since(sweep.start);
    return std::move(sweep.result);
}

}  // namespace opaline::bake
