#include "bake/lab/sweep/tables.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "bake/pipeline/provenance.h"

namespace opaline::bake {
namespace {

using Json = nlohmann::ordered_json;

// One cell of a CSV row.
std::string text_cell(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) {
        quoted += c == '"' ? "\"\"" : std::string(1, c);
    }
    return quoted + "\"";
}

std::string number_cell(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::string ladders_text(const SweepPoint& point) {
    std::string text;
    for (const Rung& rung : point.rungs) {
        text += (text.empty() ? "" : " ") + std::string(rung.ladder.name);
    }
    return text;
}

using Cells = std::vector<std::pair<std::string, std::string>>;  // column, value

std::string part_of(const std::vector<ErrorReport::Part>& parts, const std::string& name) {
    const auto part = std::find_if(parts.begin(), parts.end(),
                                   [&](const ErrorReport::Part& p) { return p.name == name; });
    return part == parts.end() ? "" : number_cell(part->rms_relative);
}

// Effects that occur, in the order in which they do.
std::vector<std::string> effects_of(const SweepResult& result) {
    std::vector<std::string> names;
    for (const PointRecord& record : result.points) {
        for (const ErrorReport::Part& part : record.error.by_effect) {
            if (std::find(names.begin(), names.end(), part.name) == names.end()) {
                names.push_back(part.name);
            }
        }
    }
    return names;
}

// Of all points, in the order in which they are first met.
std::vector<std::string> stage_group_names(const SweepResult& result) {
    std::vector<std::string> names;
    for (const PointRecord& record : result.points) {
        for (const GroupSeconds& group : record.groups) {
            if (std::find(names.begin(), names.end(), group.name) == names.end()) {
                names.push_back(group.name);
            }
        }
    }
    return names;
}

void add_knobs(Cells& cells, const Knobs& knobs) {
    const Json json = sweep_knobs_json(knobs);
    for (const auto& [key, value] : json.items()) {
        cells.emplace_back(key, value.is_string() ? value.get<std::string>() : value.dump());
    }
}

Cells cells_of(const SweepResult& result, const SweepAnalysis& analysis, std::size_t i) {
    const PointRecord& record = result.points[i];
    Cells cells{{"label", text_cell(record.point.label)},
                {"ladders", text_cell(ladders_text(record.point))},
                {"truth", i == result.truth ? "1" : "0"}};
    add_knobs(cells, record.point.knobs);
    cells.emplace_back("seconds", number_cell(record.seconds));
    cells.emplace_back("cpu_seconds", number_cell(record.cpu_seconds));
    for (const std::string& group : stage_group_names(result)) {
        cells.emplace_back("seconds " + group, number_cell(seconds_of(record.groups, group)));
    }
    cells.emplace_back("bytes", std::to_string(record.bytes));
    cells.emplace_back("peak_rss_bytes", std::to_string(record.peak_bytes));
    cells.emplace_back("error", number_cell(record.error.rms_relative));
    cells.emplace_back("error_ci95_low", number_cell(record.error.ci95[0]));
    cells.emplace_back("error_ci95_high", number_cell(record.error.ci95[1]));
    cells.emplace_back("against_finest", number_cell(record.against_finest.rms_relative));
    cells.emplace_back("against_finest_ci95_low", number_cell(record.against_finest.ci95[0]));
    cells.emplace_back("against_finest_ci95_high", number_cell(record.against_finest.ci95[1]));
    cells.emplace_back("choices", text_cell(record.choices));
    const auto total_cell = [&](double value) {
        return record.total.receivers_checked > 0 ? number_cell(value) : "";
    };
    cells.emplace_back("total_error", total_cell(record.total.rms_relative));
    cells.emplace_back("total_error_ci95_low", total_cell(record.total.ci95[0]));
    cells.emplace_back("total_error_ci95_high", total_cell(record.total.ci95[1]));
    cells.emplace_back("total_bias", total_cell(record.total.bias));
    for (const std::string& effect : effects_of(result)) {
        cells.emplace_back("error " + effect, part_of(record.error.by_effect, effect));
    }
    for (const std::string& light : result.lights) {
        cells.emplace_back(text_cell("error " + light), part_of(record.error.by_light, light));
    }
    const Standing& standing = analysis.standing[i];
    cells.emplace_back("on_front_time", standing.on_front_time ? "1" : "0");
    cells.emplace_back("on_front_bytes", standing.on_front_bytes ? "1" : "0");
    cells.emplace_back("on_front_total", standing.on_front_total ? "1" : "0");
    cells.emplace_back("times_front_time", number_cell(standing.times_front_time));
    cells.emplace_back("times_front_bytes", number_cell(standing.times_front_bytes));
    cells.emplace_back("reference_samples", "");
    return cells;
}

// The Monte Carlo reference in the same columns, as far as they mean anything to it.
Cells cells_of(const ReferenceRung& rung, const Cells& like) {
    const std::map<std::string, std::string> known{
        {"label", text_cell("Monte Carlo, " + std::to_string(rung.samples) + " samples")},
        {"ladders", std::string(Ladders::reference_samples.name)},
        {"truth", "0"},
        {"seconds", number_cell(rung.seconds)},
        {"error", number_cell(rung.error)},
        {"reference_samples", std::to_string(rung.samples)}};
    Cells cells;
    for (const auto& [column, other] : like) {
        const auto own = known.find(column);
        cells.emplace_back(column, own == known.end() ? "" : own->second);
    }
    return cells;
}

Json point_json(const SweepResult& result, const SweepAnalysis& analysis, std::size_t i) {
    const PointRecord& record = result.points[i];
    Json json = {{"label", record.point.label}, {"ladders", Json::object()}};
    for (const Rung& rung : record.point.rungs) {
        json["ladders"][std::string(rung.ladder.name)] = rung.value;
    }
    json["knobs"] = sweep_knobs_json(record.point.knobs);
    json["seconds"] = record.seconds;
    json["cpu_seconds"] = record.cpu_seconds;
    json["seconds_by_group"] = Json::array();
    for (const std::string& group : stage_group_names(result)) {
        json["seconds_by_group"].push_back(seconds_of(record.groups, group));
    }
    json["stages"] = Json::array();
    for (const StageReport& stage : record.stages) {
        json["stages"].push_back(
            {{"name", stage.name}, {"seconds", stage.seconds}, {"rays", stage.rays}});
    }
    json["bytes"] = record.bytes;
    json["peak_rss_bytes"] = record.peak_bytes;
    json["error"] = error_json(record.error);
    json["finest"] = record.finest;
    json["against_finest"] = error_json(record.against_finest);
    json["choices"] = record.choices;
    if (record.total.receivers_checked > 0) {
        json["total_error"] = {{"rms_relative", record.total.rms_relative},
                               {"ci95", {record.total.ci95[0], record.total.ci95[1]}},
                               {"bias", record.total.bias}};
    }
    if (record.volumes.rays_checked > 0) {
        json["volume_error"] = volume_error_json(record.volumes);
    }
    if (record.layer) {
        json["layer_error"] = layer_error_json(*record.layer);
    }
    const Standing& standing = analysis.standing[i];
    json["on_front_time"] = standing.on_front_time;
    json["on_front_bytes"] = standing.on_front_bytes;
    json["on_front_total"] = standing.on_front_total;
    json["times_front_time"] = standing.times_front_time;
    json["times_front_bytes"] = standing.times_front_bytes;
    return json;
}

Json fit_json(const LadderFit& ladder) {
    Json json = {{"ladder", ladder.ladder.name},
                 {"knob", ladder.theory.knob},
                 {"against", ladder.against},
                 {"semi_log", ladder.theory.semi_log},
                 {"theory", {{"rate", ladder.theory.rate}, {"words", ladder.theory.words}}},
                 {"rungs", Json::array()}};
    for (const Convergence& rung : ladder.rungs) {
        const bool used = ladder.fit && std::find(ladder.fit->used.begin(), ladder.fit->used.end(),
                                                  rung.value) != ladder.fit->used.end();
        json["rungs"].push_back({{"value", rung.value},
                                 {"error", rung.error},
                                 {"seconds", rung.seconds},
                                 {"fitted", used}});
    }
    if (ladder.fit) {
        json["measured"] = {{"rate", ladder.fit->slope},
                            {"standard_error", ladder.fit->standard_error},
                            {"intercept", ladder.fit->intercept},
                            {"saturated", ladder.fit->saturated}};
    }
    return json;
}

Json reference_json(const ReferenceLadder& reference) {
    Json json = {{"light", reference.light},
                 {"receivers", reference.receivers},
                 {"truth_samples", reference.truth_samples},
                 {"rungs", Json::array()}};
    for (const ReferenceRung& rung : reference.rungs) {
        json["rungs"].push_back({{"samples", rung.samples},
                                 {"seconds", rung.seconds},
                                 {"error", rung.error},
                                 {"stated", rung.stated}});
    }
    return json;
}

Json plan_json(const std::vector<PlanEntry>& plan) {
    Json json = Json::array();
    for (const PlanEntry& entry : plan) {
        json.push_back({{"effect", entry.name},
                        {"subject", entry.subject.name},
                        {"decision", entry.on ? "on" : "off"},
                        {"reason", entry.reason}});
    }
    return json;
}

Json pair_json(const std::optional<CostPair>& pair) {
    return pair ? Json{{"better", pair->better}, {"other", pair->other}} : Json();
}

}  // namespace

Json sweep_knobs_json(const Knobs& knobs) {
    Json json = knobs_json(knobs);
    json.erase("separate_terms");  // never in a sweep
    for (const auto& [knob, value] : knobs.values.values) {
        if (knob->exact_if_given) {
            json["exact_" + std::string(knob->name)] = knobs.is_given(*knob);
        }
    }
    json["exact_rays"] = knobs.exact_rays;
    return json;
}

std::string make_sweep_csv(const SweepResult& result, const SweepAnalysis& analysis) {
    std::vector<Cells> rows;
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        rows.push_back(cells_of(result, analysis, i));
    }
    if (result.reference && !rows.empty()) {
        for (const ReferenceRung& rung : result.reference->rungs) {
            rows.push_back(cells_of(rung, rows.front()));
        }
    }
    std::string table;
    for (const Cells& cells : rows) {
        std::string head, row;
        for (const auto& [column, value] : cells) {
            head += "," + column;
            row += "," + value;
        }
        table += (table.empty() ? head.substr(1) + "\n" : "") + row.substr(1) + "\n";
    }
    return table;
}

Json make_sweep_json(const SweepResult& result, const SweepAnalysis& analysis) {
    Json json;
    json["version"] = OPALINE_VERSION;
    json["scene"] = {{"name", result.source},
                     {"sha256", result.sha256},
                     {"receivers", result.receivers},
                     {"triangles", result.triangles}};
    json["seed"] = result.seed;
    json["threads"] = result.threads;
    json["seconds_total"] = result.seconds;
    json["lights"] = result.lights;
    json["picture_light"] = result.picture_light;
    json["groups"] = stage_group_names(result);
    json["knobs"] = Json::array();  // of effects that the scene calls for; `choices` say the others
    for (const KnobSpec* knob : result.subject.knobs) {
        if (knob->words.empty()) {
            json["knobs"].push_back(knob->name);
        }
    }
    json["base"] = quality_name(result.base);
    json["plan"] = plan_json(result.plan);
    if (analysis.answer) {
        json["answer"] = {{"error", analysis.answer->error},
                          {"seconds", analysis.answer->seconds},
                          {"bytes", analysis.answer->bytes},
                          {"times_for_half", analysis.answer->halving}};
    }
    json["lines"] = Json::array();  // total error against time, one line for each way to choose
    for (const ChoiceLine& line : analysis.lines) {
        json["lines"].push_back({{"choices", line.choices}, {"points", line.front}});
    }
    json["truth"] = result.truth;
    json["points"] = Json::array();
    for (std::size_t i = 0; i < result.points.size(); ++i) {
        json["points"].push_back(point_json(result, analysis, i));
    }
    json["slopes"] = Json::array();
    for (const LadderFit& fit : analysis.fits) {
        json["slopes"].push_back(fit_json(fit));
    }
    if (result.reference) {
        json["reference"] = reference_json(*result.reference);
    }
    json["pairs"] = {{"equal_time", pair_json(analysis.equal_time)},
                     {"equal_error", pair_json(analysis.equal_error)}};
    json["agreement"] = {{"agreeing", analysis.checks_agreeing}, {"of", analysis.checks}};
    json["model_error"] = model_error_json(result.points[result.truth].total);
    json["skipped"] = Json::array();
    for (const SkippedPoint& skipped : result.skipped) {
        json["skipped"].push_back({{"label", skipped.point.label},
                                   {"predicted_seconds", skipped.predicted_seconds},
                                   {"predicted_bytes", skipped.predicted_bytes},
                                   {"reason", skipped.reason}});
    }
    return json;
}

}  // namespace opaline::bake
