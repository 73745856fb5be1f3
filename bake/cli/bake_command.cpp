#include <fmt/core.h>

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/interrupt.h"
#include "bake/cli/machine_rates.h"
#include "bake/cli/messages.h"
#include "bake/cli/progress.h"
#include "bake/cli/report.h"
#include "bake/cli/scene_options.h"
#include "bake/effects/effects.h"
#include "bake/pipeline/pipeline.h"
#include "bake/pipeline/savings.h"
#include "bake/pipeline/unmet_requests.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/write_opal.h"

namespace opaline::cli {
namespace {

struct Options {
    SceneOptions scene;
    std::string output, report, depfile;
    ProgressStyle progress = ProgressStyle::automatic;
};

void print_summary(const Options& options, const bake::BakeResult& result, std::uint64_t bytes,
                   std::size_t warnings) {
    fmt::print(stderr,
               "{}: {} receivers, {}, {}; measured error {:.2f} % (95 %: {:.2f} to {:.2f}; "
               "{:.2f} % at vertices, {:.2f} % between)",
               options.output, result.asset.position.size(), format_seconds(result.seconds_total),
               format_bytes(static_cast<double>(bytes)), 100 * result.error.rms_relative,
               100 * result.error.ci95[0], 100 * result.error.ci95[1],
               100 * result.error.at_receivers.rms_relative,
               100 * result.error.between.rms_relative);
    if (result.accuracy) {
        fmt::print(stderr, "; asked for {:g} %, expected {:.2f} %", 100 * result.accuracy->target,
                   100 * result.accuracy->predicted);
    }
    if (const auto& model = result.model_error) {
        fmt::print(stderr, "; model error {:.1f} % (95 %: {:.1f} to {:.1f}), mean {:+.1f} %",
                   100 * model->rms_relative, 100 * model->ci95[0], 100 * model->ci95[1],
                   100 * model->bias);
    }
    fmt::print(stderr, "{}\n",
               warnings == 0   ? ""
               : warnings == 1 ? "; 1 warning"
                               : "; " + std::to_string(warnings) + " warnings");
}

// Nothing where no path was given.
formats::Result<std::optional<formats::AtomicFile>> create_output(const std::string& path) {
    if (path.empty()) {
        return std::optional<formats::AtomicFile>();
    }
    auto file = formats::AtomicFile::create(path);
    if (!file) {
        return std::move(file).error();
    }
    return std::optional(std::move(*file));
}

formats::Status write_output(std::optional<formats::AtomicFile>& file, std::string_view text) {
    if (!file) {
        return formats::ok_status();
    }
    const formats::Status status = file->write(text);
    return status ? file->commit() : status;
}

// What the stages were expected to take, before a pilot changed any knob; and the plan's entries,
// of the knobs that were used.
Expectation expect(const formats::Scene& scene, const bake::Knobs& wanted,
                   const MachineRates& machine, bake::BakeResult& result) {
    const bake::EffectTable& effects = bake::all_effects();
    const bake::CostRequest used{effects,      scene,         result.facts,
                                 result.knobs, machine.rates, result.threads};
    bake::predict_costs(used, result.plan);
    bake::predict_savings(used, result.plan);
    std::vector<bake::PlanEntry> first = bake::plan_bake(effects, scene, result.facts, wanted);
    return {bake::predict_costs(
                {effects, scene, result.facts, wanted, machine.rates, result.threads}, first),
            machine.note};
}

int run(const Options& options) {
    const std::atomic<bool>& interrupted = catch_interrupts();
    const auto wanted = parse_effects(options.scene);
    if (!wanted) {
        return report_error(wanted.error());
    }
    const auto knobs = bake::resolve_knobs(bake::all_effects(), *wanted);
    if (!knobs) {
        return report_error(knobs.error());
    }
    auto imported =
        open_scene(options.scene.scene, options.scene.metres_per_unit, options.scene.media);
    if (!imported) {
        return report_error(imported.error());
    }
    if (auto status = bake::check_effects(bake::all_effects(), imported->scene, *knobs); !status) {
        return report_error(status.error());
    }
    for (const std::string* path : {&options.output, &options.report, &options.depfile}) {
        if (auto status = check_output(*path, imported->scene.inputs, {}); !status) {
            return report_error(status.error());
        }
    }
    // Before the work, so that an unwritable folder is found out at once.
    auto file = create_output(options.output);
    auto report_file = create_output(options.report);
    auto depfile = create_output(options.depfile);
    for (const auto* output : {&file, &report_file, &depfile}) {
        if (!*output) {
            return report_error(output->error());
        }
    }
    // Predictions stand in the report alone: without one this machine need not be measured.
    const std::optional<MachineRates> machine =
        *report_file ? std::optional(find_machine_rates()) : std::nullopt;
    bake::Context context;
    context.threads = options.scene.bake.threads;
    context.cancel = &interrupted;
    context.on_progress = make_progress_printer(options.progress);
    auto result = bake::run_bake(bake::all_effects(), imported->scene, *knobs, context);
    if (!result) {
        return report_error(result.error());
    }
    if (auto status = formats::write_opal(result->asset.view(), std::move(**file)); !status) {
        return report_error(status.error());
    }
    std::error_code ignored;
    const std::uint64_t bytes = std::filesystem::is_regular_file(options.output, ignored)
                                    ? std::filesystem::file_size(options.output, ignored)
                                    : 0;
    for (formats::Diagnostic& unmet :
         bake::describe_unmet({bake::all_effects(), imported->scene, result->facts, result->knobs,
                               result->plan},
                              *wanted)) {
        result->warnings.push_back(std::move(unmet));
    }
    std::vector<formats::Diagnostic> warnings = imported->warnings;
    warnings.insert(warnings.end(), result->warnings.begin(), result->warnings.end());
    print_warnings(result->warnings);
    std::string report;
    if (machine) {
        const Expectation expected = expect(imported->scene, *knobs, *machine, *result);
        report = make_report(imported->scene, *result, expected, warnings, bytes);
    }
    std::string rule = make_depfile(options.output, imported->scene.inputs);
    for (const auto& [output, text] : {std::pair{&*report_file, &report}, {&*depfile, &rule}}) {
        if (auto status = write_output(*output, *text); !status) {
            return report_error(status.error());
        }
    }
    print_summary(options, *result, bytes, warnings.size());
    return kExitSuccess;
}

}  // namespace

void add_bake_command(CLI::App& app, Job& job) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("bake", "Bake a scene into an .opal file");
    add_scene_options(*command, options->scene);
    add_error_option(*command, options->scene);
    command->add_flag("--check-model", options->scene.bake.check_model,
                      "also measure how far the physical model is from a Monte Carlo reference "
                      "(seconds to a minute); the report gets `model_error`");
    command->add_option("-o,--output", options->output, "the .opal file to write")->required();
    command->add_option("--report", options->report, "write a JSON report: plan, stages, error");
    command->add_option("--depfile", options->depfile,
                        "write the files read as a rule for make and ninja");
    command
        ->add_option("--progress", options->progress,
                     "auto: a bar on a terminal; json: a line of JSON a step on stderr; none")
        ->transform(CLI::CheckedTransformer(
            std::map<std::string, ProgressStyle>{{"auto", ProgressStyle::automatic},
                                                 {"json", ProgressStyle::json},
                                                 {"none", ProgressStyle::none}}))
        ->option_text("auto|json|none [auto]");
    command->footer("Example:\n  opaline bake scene.glb -o scene.opal --quality production");
    command->callback([options, &job] { job = [options] { return run(*options); }; });
}

}  // namespace opaline::cli
