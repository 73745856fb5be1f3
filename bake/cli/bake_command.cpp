#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/progress.h"
#include "bake/cli/report.h"
#include "bake/cli/scene_options.h"
#include "bake/effects/effects.h"
#include "bake/pipeline/calibration/rates_cache.h"
#include "bake/pipeline/pipeline.h"
#include "bake/pipeline/savings.h"
#include "bake/pipeline/unmet_requests.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/write_opal.h"

namespace opaline::cli {
namespace {

struct BakeCommand {
    SceneOptions scene;
    std::string output, report, depfile;
    bool verbose = false;
    formats::Compression compression = formats::Compression::fast;
    bake::BakeExtras extras;
    ProgressStyle progress = ProgressStyle::automatic;
};

// "4.1 % (95 %: 3.2 to 5.0)"
template <class Measured>
std::string percent_of_rms(const Measured& error) {
    return fmt::format("{:.1f} % (95 %: {:.1f} to {:.1f})", 100 * error.rms_relative,
                       100 * error.ci95[0], 100 * error.ci95[1]);
}

void print_summary(const BakeCommand& options, const bake::BakeResult& result, std::uint64_t bytes,
                   std::size_t warnings) {
    const std::size_t nodes = result.asset.volumes.node.size();
    std::string line = fmt::format(
        "{}: {} receivers{}, {}{}, {}", printable(options.output),
        formats::count_restored_vertices(result.asset.view()),
        result.refinement.added > 0 ? fmt::format(" ({} added)", result.refinement.added) : "",
        nodes > 0 ? fmt::format("{} nodes in volumes, ", nodes) : "",
        format_seconds(result.seconds_total), format_bytes(static_cast<double>(bytes)));
    if (result.error.receivers_checked > 0) {
        line += fmt::format(
            "; measured error {:.2f} % (95 %: {:.2f} to {:.2f}; {:.2f} % at vertices, {:.2f} % "
            "between)",
            100 * result.error.rms_relative, 100 * result.error.ci95[0], 100 * result.error.ci95[1],
            100 * result.error.at_receivers.rms_relative, 100 * result.error.between.rms_relative);
    }
    if (const auto& names = result.error.not_measured; !names.empty()) {
        line += fmt::format("; not measured: {}", fmt::join(names, ", "));
    }
    if (result.knobs.model_error > 0.0005 && !result.model_error) {
        line += fmt::format("; the model errs by some {:.1f} %", 100 * result.knobs.model_error);
    }
    if (result.accuracy) {
        line += fmt::format("; asked for {:g} %", 100 * result.accuracy->target);
        // Of volumes nothing is expected: they are measured.
        if (result.error.receivers_checked > 0) {
            line += fmt::format(", expected {:.2f} %{}", 100 * result.accuracy->predicted,
                                result.accuracy->model > 0 ? " besides the model" : "");
        }
    }
    if (const auto& model = result.model_error) {
        line += fmt::format("; model error {}, mean {:+.1f} %", percent_of_rms(*model),
                            100 * model->bias);
        if (model->mirrored) line += "; mirrored light " + percent_of_rms(*model->mirrored);
        if (model->suns) line += "; under suns of 5 degrees " + percent_of_rms(*model->suns);
    }
    if (const auto& volumes = result.volume_error) {
        std::string text = percent_of_rms(*volumes);
        text.pop_back();
        for (const bake::VolumeErrorReport::Part& part : volumes->by_light) {
            text += fmt::format("{} {} {:.1f} %", &part == &volumes->by_light.front() ? ";" : ",",
                                part.name, 100 * part.rms_relative);
        }
        line += "; volumes err by " + text + ")";
    }
    if (result.layer_error) line += "; cloud layer errs by " + percent_of_rms(*result.layer_error);
    if (warnings > 0) line += fmt::format("; {} warning{}", warnings, warnings == 1 ? "" : "s");
    print_note(line);
}

void print_stages(const bake::BakeResult& result) {
    for (const bake::PlanEntry& entry : result.plan) {
        print_note(fmt::format("{} {} for {}: {}", entry.name, entry.on ? "on" : "off",
                               printable(entry.subject.name), printable(entry.reason)));
    }
    for (const bake::StageReport& stage : result.stages) {
        print_note(fmt::format("{:<32} {:>10}  {:>12} rays  peak {}", printable(stage.name),
                               format_seconds(stage.seconds), stage.rays,
                               format_bytes(static_cast<double>(stage.peak_rss_bytes))));
    }
}

// Those that were asked for; the .opal file is the last.
std::vector<OutputFile> name_outputs(const BakeCommand& options) {
    std::vector<OutputFile> outputs;
    for (const OutputFile& output : {OutputFile{"--report", options.report, {}},
                                     {"--depfile", options.depfile, {}},
                                     {"--output", options.output, {}}}) {
        if (!output.path.empty()) {
            outputs.push_back(output);
        }
    }
    return outputs;
}

// Predicted seconds of the stages, before a pilot changed any knob.
Expectation expect(const formats::Scene& scene, const bake::Knobs& wanted,
                   const bake::MachineRates& machine, const bake::BakeExtras& extras,
                   const bake::BakeResult& result) {
    const bake::EffectTable& effects = bake::all_effects();
    std::vector<bake::PlanEntry> first = result.plan;
    bake::replace_entries(bake::Subject::Kind::material,
                          bake::plan_bake(effects, scene, result.facts, wanted), first);
    const bake::Knobs budget =
        bake::with_model_error(effects, wanted, bake::find_model_error(first));
    return {bake::predict_costs({effects, scene, result.facts, budget, machine.rates,
                                 result.threads, extras.receiver_errors, result.refinement.rays},
                                first),
            machine.note};
}

// Those that were not said before, each once.
std::vector<formats::Diagnostic> drop_said(std::vector<formats::Diagnostic> warnings,
                                           std::vector<formats::Diagnostic> said) {
    std::vector<formats::Diagnostic> fresh;
    for (formats::Diagnostic& warning : warnings) {
        const auto is_same = [&](const formats::Diagnostic& other) {
            return other.file == warning.file && other.where == warning.where &&
                   other.fault == warning.fault;
        };
        if (std::ranges::none_of(said, is_same)) {
            said.push_back(warning);
            fresh.push_back(std::move(warning));
        }
    }
    return fresh;
}

int run(const BakeCommand& options) {
    const std::atomic<bool>& interrupted = catch_interrupts();
    const auto wanted = parse_effects(options.scene);
    auto knobs = require(bake::resolve_knobs(bake::all_effects(), wanted));
    auto imported = open_scene(options.scene, knobs, formats::CloudDetail::fields);
    knobs = fit_memory(options.scene, imported.scene, knobs);
    require(bake::check_effects(bake::all_effects(), imported.scene, knobs));
    const std::vector<OutputFile> outputs = name_outputs(options);
    if (is_scene_ending(ending_of(options.output))) {
        refuse(formats::make_error(formats::ErrorKind::usage, options.output, "--output",
                                   "programs would take it for a scene by its ending",
                                   "end the name in .opal"));
    }
    require(check_outputs(outputs, imported.scene.inputs));
    std::vector<formats::AtomicFile> files = create_outputs(outputs);
    bake::Context context;
    context.threads = options.scene.bake.threads;
    context.cancel = &interrupted;
    context.cache = bake::cache_folder();
    context.on_progress = make_progress_printer(options.progress, "bake");
    std::vector<formats::Diagnostic> warnings = imported.warnings;
    bake::BakeExtras extras = options.extras;
    extras.on_planned = [&](const formats::Scene& scene, const bake::BakeResult& planned) {
        const auto early = bake::describe_early(
            {bake::all_effects(), scene, planned.facts, planned.knobs, planned.plan});
        require(report_warnings(early));
        warnings.insert(warnings.end(), early.begin(), early.end());
    };
    auto result =
        require(bake::run_bake(bake::all_effects(), imported.scene, knobs, context, extras));
    const formats::Scene& baked = result.scene ? *result.scene : imported.scene;
    for (formats::Diagnostic& unmet : bake::describe_unmet(
             {bake::all_effects(), baked, result.facts, result.knobs, result.plan}, wanted)) {
        result.warnings.push_back(std::move(unmet));
    }
    result.warnings = drop_said(std::move(result.warnings), warnings);
    warnings.insert(warnings.end(), result.warnings.begin(), result.warnings.end());
    require(report_warnings(result.warnings));
    formats::AtomicFile& file = files.back();
    require(formats::write_opal_bytes(result.asset.view(), file, result.receiver_errors,
                                      options.compression));
    const std::uint64_t bytes = file.bytes_written();
    std::size_t next = 0;
    const bake::MachineRates machine = bake::find_machine_rates();
    const bake::CostRequest request{bake::all_effects(),
                                    baked,
                                    result.facts,
                                    result.knobs,
                                    machine.rates,
                                    result.threads,
                                    options.extras.receiver_errors,
                                    result.refinement.rays};
    const bake::CostPrediction used = bake::predict_costs(request, result.plan);
    if (!options.report.empty()) {
        bake::predict_savings(request, result.plan);
        const Expectation expected = expect(baked, knobs, machine, options.extras, result);
        require(files[next++].write(make_report(baked, result, expected, warnings, bytes)));
    }
    if (!options.depfile.empty()) {
        require(files[next].write(make_depfile(options.output, imported.scene.inputs)));
    }
    commit_outputs(files);
    bake::learn_machine_rates(used.stages, result.stages, machine.rates);
    if (context.on_progress) context.on_progress({"bake", 1, 1});
    if (options.verbose) {
        print_stages(result);
    }
    print_summary(options, result, bytes, warnings.size());
    return kExitSuccess;
}

}  // namespace

void add_bake_command(Program& program) {
    auto [command, options] =
        add_command<BakeCommand>(program, "bake", "Bake a scene into an .opal file", run);
    add_scene_options(command, options.scene);
    add_error_option(command, options.scene);
    command.add_flag("--check-model", options.scene.bake.check_model,
                     "also measure how far the physical model is from a Monte Carlo reference "
                     "(seconds to a minute); the report gets `model_error`. Volumes are measured "
                     "in every bake, and more closely with this");
    command
        .add("-o,--output", "OUT.opal REQUIRED", file_name(options.output),
             "the .opal file to write")
        .required();
    command.add("--report", file_name(options.report), "write a JSON report: plan, stages, error");
    command.add("--depfile", file_name(options.depfile),
                "write the files read as a rule for make and ninja");
    command.add_flag("--receiver-errors", options.extras.receiver_errors,
                     "also store how far the rows of each vertex are from those before "
                     "coefficients were dropped and rounded (4 bytes a vertex): a map of it is "
                     "shown by `view` and `render --receiver-errors`");
    command.add("--compression",
                one_of(options.compression, {{"none", formats::Compression::none},
                                             {"fast", formats::Compression::fast},
                                             {"best", formats::Compression::best}}),
                "of the file: fast or best (slow to write) take a third to a half of the bytes, "
                "which a program decodes as it loads them; rows of none are used in place. "
                "Predicted sizes are those of none");
    command.add_flag("--verbose", options.verbose,
                     "also print what is simulated and why, and what each stage took");
    add_progress_option(command, options.progress);
    // What a first bake needs, then the rest.
    command.group({{"", {"--output", "--media", "--quality", "--error", "--metres-per-unit"}},
                   {"Receivers", {"--refine", "--max-receivers", "--simplify"}},
                   {"What is simulated",
                    {"--effects", "--separate-terms", "--multiple-model", "--volume-method"}},
                   {"Machine", {"--threads", "--memory-limit"}},
                   {"What is reported",
                    {"--report", "--depfile", "--progress", "--verbose", "--check-model",
                     "--receiver-errors"}}},
                  "Knobs, which --quality and --error set");
    command.footer("Example:\n  opaline bake scene.glb -o scene.opal --quality production");
}

}  // namespace opaline::cli
