#include "bake/cli/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bake/cli/json_output.h"
#include "bake/cli/messages.h"
#include "bake/pipeline/provenance.h"

namespace opaline::cli {
namespace {

using Json = nlohmann::ordered_json;

Json plan_array(const std::vector<bake::PlanEntry>& plan) {
    Json array = Json::array();
    for (const bake::PlanEntry& entry : plan) {
        array.push_back({{"effect", entry.name},
                         {"subject", entry.subject.name},
                         {"decision", entry.on ? "on" : "off"},
                         {"forced", entry.forced},
                         {"reason", entry.reason},
                         {"bound", entry.bound},
                         {"model_error", entry.model_error},
                         {"predicted_seconds", entry.predicted_seconds},
                         {"predicted_bytes", entry.predicted_bytes},
                         {"saved_seconds", entry.saved_seconds},
                         {"saved_bytes", entry.saved_bytes}});
    }
    return array;
}

// At the end of a reason; empty where nothing worth mentioning is saved.
std::string savings_text(const bake::PlanEntry& entry) {
    constexpr double kLeastSeconds = 0.01, kLeastBytes = 1000;
    const auto size = static_cast<double>(entry.saved_bytes);
    if (entry.saved_seconds < kLeastSeconds && size < kLeastBytes) {
        return {};
    }
    return fmt::format("; saves {}{}", format_seconds(entry.saved_seconds),
                       size < kLeastBytes ? "" : " and " + format_bytes(size));
}

std::string coefficients_text(const bake::Knobs& knobs) {
    return knobs.coefficients == bake::kAllCoefficients
               ? "all coefficients"
               : fmt::format("{} coefficients a row", knobs.coefficients);
}

// Of the first of that name that is left. A pilot's further rounds are not predicted: 0.
double take_predicted(std::vector<bake::StageCost>& costs, const std::string& name) {
    const auto found = std::find_if(costs.begin(), costs.end(),
                                    [&](const bake::StageCost& cost) { return cost.name == name; });
    if (found == costs.end()) return 0;
    const double seconds = found->seconds;
    costs.erase(found);
    return seconds;
}

Json accuracy_json(const bake::AccuracyReport& accuracy) {
    Json trials = Json::array();
    for (const auto& [knobs, trial] : accuracy.trials) {
        trials.push_back(
            {{"round", bake::knobs_json(knobs)},
             {"knob", trial.knob},
             {"value", trial.value == bake::kAllCoefficients ? Json("all") : Json(trial.value)},
             {"code_bits", trial.code_bits},
             {"error", trial.error}});
    }
    return {{"error_requested", accuracy.target},
            {"model_error", accuracy.model},
            {"numerical_target", accuracy.numerical},
            {"error_predicted", accuracy.predicted},
            {"error_likely", accuracy.likely},
            {"met", accuracy.met},
            {"trials", std::move(trials)}};
}

// Receivers that have rows: fewer where vertices share them.
std::size_t slots_of(const formats::Asset& asset) {
    return asset.slots.empty() ? asset.position.size() : asset.slots.vertex.size();
}

// Of any primitive: they may differ.
std::uint32_t most_terms(const formats::Asset& asset) {
    std::uint32_t most = 0;
    for (const formats::PrimitiveRecord& primitive : asset.primitives) {
        most = std::max(most, primitive.terms);
    }
    return most;
}

}  // namespace

namespace {

const char* end_name(bake::RefineEnd end) {
    switch (end) {
        case bake::RefineEnd::met:
            return "met";
        case bake::RefineEnd::receivers:
            return "receivers";
        case bake::RefineEnd::points:
            return "points";
        case bake::RefineEnd::edges:
            return "edges";
        case bake::RefineEnd::returns:
            return "returns";
    }
    return "";
}

// What kept it from the error asked for; nothing where it was met.
const char* describe_end(bake::RefineEnd end) {
    switch (end) {
        case bake::RefineEnd::met:
            return "";
        case bake::RefineEnd::receivers:
            return "; --max-receivers ends it";
        case bake::RefineEnd::points:
            return "; the rest lies in small triangles of the scene";
        case bake::RefineEnd::edges:
            return "; the rest is narrower than edges may be";
        case bake::RefineEnd::returns:
            return "; more receivers would hardly lower that";
    }
    return "";
}

Json refinement_json(const bake::RefineReport& refined) {
    return {{"receivers_given", refined.given},     {"receivers_added", refined.added},
            {"error_before", refined.error_before}, {"error_after", refined.error_after},
            {"ended_by", end_name(refined.end)},    {"bounded", refined.is_bounded()}};
}

}  // namespace

std::string make_report(const formats::Scene& scene, const bake::BakeResult& result,
                        const Expectation& expected,
                        const std::vector<formats::Diagnostic>& warnings, std::uint64_t bytes) {
    Json report;
    report["version"] = OPALINE_VERSION;
    report["scene"]["sha256"] = scene.sha256;
    report["seed"] = result.knobs.seed;
    report["threads"] = result.threads;
    report["knobs"] = bake::knobs_json(result.knobs);
    report["plan"] = plan_array(result.plan);
    report["stages"] = Json::array();
    std::vector<bake::StageCost> costs = expected.cost.stages;
    for (const bake::StageReport& stage : result.stages) {
        report["stages"].push_back({{"name", stage.name},
                                    {"seconds", stage.seconds},
                                    {"cpu_seconds", stage.cpu_seconds},
                                    {"predicted_seconds", take_predicted(costs, stage.name)},
                                    {"rays", stage.rays},
                                    {"peak_rss_bytes", stage.peak_rss_bytes}});
    }
    report["seconds_total"] = result.seconds_total;
    report["predicted_seconds_total"] = expected.cost.seconds;
    report["calibration"] = expected.rates_note;
    report["error"] = bake::error_json(result.error);
    report["error"]["model_estimate"] = result.knobs.model_error;
    if (result.accuracy) {
        report["accuracy"] = accuracy_json(*result.accuracy);
    }
    bake::add_other_errors(result, report);
    if (result.model_error) report["model_error"]["seconds"] = result.model_error->seconds;
    for (const bake::VolumeTrial& trial : result.volume_trials) {
        report["volume_trials"].push_back(
            {{"quality", bake::quality_name(trial.quality)}, {"error", trial.error}});
    }
    if (result.refinement.given > 0) {
        report["refinement"] = refinement_json(result.refinement);
    }
    if (result.simplification.kept < result.simplification.given) {
        report["simplification"] = {{"receivers_given", result.simplification.given},
                                    {"receivers_kept", result.simplification.kept},
                                    {"error", result.simplification.error}};
    }
    report["output"] = {{"bytes", bytes},
                        {"receivers", formats::count_restored_vertices(result.asset.view())},
                        {"copies", result.asset.copies.size()},
                        {"slots", slots_of(result.asset)},
                        {"rows", result.asset.transport.view().rows()},
                        {"terms", most_terms(result.asset)},
                        {"coefficients_per_term", report["knobs"]["coefficients"]}};
    report["warnings"] = Json::array();
    for (const formats::Diagnostic& warning : warnings) {
        report["warnings"].push_back(format_diagnostic(warning));
    }
    return json_text(report);
}

std::string make_plan_json(const bake::Knobs& knobs, const bake::RefineReport& refined,
                           const std::vector<bake::PlanEntry>& plan,
                           const bake::CostPrediction& cost) {
    Json stages = Json::array();
    for (const bake::StageCost& stage : cost.stages) {
        stages.push_back({{"name", stage.name}, {"predicted_seconds", stage.seconds}});
    }
    return json_text(Json{{"plan", plan_array(plan)},
                          {"knobs", bake::knobs_json(knobs)},
                          {"refinement", refinement_json(refined)},
                          {"stages", std::move(stages)},
                          {"predicted_seconds_total", cost.seconds},
                          {"predicted_seconds_shared", cost.shared_seconds},
                          {"predicted_bytes_total", cost.bytes},
                          {"predicted_bytes_shared", cost.shared_bytes},
                          {"predicted_memory_bytes", cost.memory_bytes},
                          {"receivers", cost.vertices},
                          {"slots", cost.receivers}});
}

std::string make_plan_table(const bake::Knobs& knobs, const bake::RefineReport& refined,
                            const std::vector<bake::PlanEntry>& plan,
                            const bake::CostPrediction& cost, unsigned threads) {
    const std::string everything = "whole scene", rest = "the rest";
    std::size_t widest = everything.size(), widest_effect = rest.size();
    for (const bake::PlanEntry& entry : plan) {
        widest = std::max(widest, printable(entry.subject.name).size());
        widest_effect = std::max(widest_effect, entry.name.size());
    }
    std::string table =
        fmt::format("{:<{}} {:<{}} {:<8} {:>6} {:>10} {:>10}  {}\n", "effect", widest_effect,
                    "subject", widest, "decision", "bound", "time", "size", "reason");
    const auto bytes = [](std::uint64_t count) { return format_bytes(static_cast<double>(count)); };
    for (const bake::PlanEntry& entry : plan) {
        // A part that is decided by itself costs what its effect does.
        const std::string seconds =
            entry.predicted_seconds > 0 ? format_seconds(entry.predicted_seconds) : "-";
        const std::string size = entry.predicted_bytes > 0 ? bytes(entry.predicted_bytes) : "-";
        const std::string bound =
            std::isnan(entry.bound) ? "none" : fmt::format("{:.3f}", entry.bound);
        table +=
            fmt::format("{:<{}} {:<{}} {:<8} {:>6} {:>10} {:>10}  {}\n", entry.name, widest_effect,
                        printable(entry.subject.name), widest, entry.on ? "on" : "off", bound,
                        seconds, size, printable(entry.reason) + savings_text(entry));
    }
    table += fmt::format("{:<{}} {:<{}} {:<8} {:>6} {:>10} {:>10}  {}\n", rest, widest_effect,
                         everything, widest, "always", "", format_seconds(cost.shared_seconds),
                         bytes(cost.shared_bytes),
                         "ray hierarchy, receivers, test lights, self-check; mesh and images");
    const std::string asked_for =
        knobs.error_target > 0
            ? fmt::format("for the pilot of --error {:g} to begin with", knobs.error_target)
            : fmt::format("--quality {}", bake::quality_name(knobs.quality));
    table += fmt::format("knobs ({}): {} texels along a face of the light's cube map, {}\n",
                         asked_for, knobs.cubemap_size, coefficients_text(knobs));
    if (knobs.model_error > 0.0005) {
        table += fmt::format("model error: some {:.1f} %", 100 * knobs.model_error);
        if (knobs.error_target > 0) {
            table +=
                knobs.model_error < knobs.error_target
                    ? fmt::format(", which leaves {:.2f} % to the numerical error",
                                  100 * knobs.numerical_target())
                    : fmt::format(", more than the {:g} % asked for", 100 * knobs.error_target);
        }
        table += "\n";
    }
    if (refined.added > 0) {
        table +=
            fmt::format("receivers: {} of the scene and {} more", refined.given, refined.added);
        if (refined.error_before > 0) {
            table += fmt::format(
                " where its light changes; between them it then errs by some {:.1f} %, not "
                "{:.1f}{}",
                100 * refined.error_after, 100 * refined.error_before, describe_end(refined.end));
        }
        table += "\n";
    }
    const std::string shared =
        cost.receivers < cost.vertices
            ? fmt::format(" that share the rows of {} (--simplify)", cost.receivers)
            : "";
    if (refined.given == 0 && cost.receivers > 0 &&
        knobs.refine.mode != bake::RefineChoice::Mode::off) {
        table +=
            "receivers: of a scene as large as this one a plan does not look for those that a "
            "bake adds\n";
    }
    return table + fmt::format("predicted: {} on {}, {}, {} receivers{}, {} of memory\n",
                               format_seconds(cost.seconds),
                               threads == 1 ? "1 thread" : fmt::format("{} threads", threads),
                               bytes(cost.bytes), cost.vertices, shared, bytes(cost.memory_bytes));
}

std::string make_depfile(const std::filesystem::path& output,
                         const std::vector<std::filesystem::path>& inputs) {
    const auto escape = [](const std::string& path) {
        std::string text;
        for (const char c : path) {
            text += c == '$' ? "$$" : c == ' ' ? "\\ " : c == '#' ? "\\#" : std::string(1, c);
        }
        return text;
    };
    std::string rule = escape(output.string()) + ":";
    for (const std::filesystem::path& input : inputs) {
        rule += " \\\n  " + escape(input.string());
    }
    return rule + "\n";
}

}  // namespace opaline::cli
