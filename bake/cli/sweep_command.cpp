#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "bake/base/stage_log.h"
#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/progress.h"
#include "bake/cli/scene_options.h"
#include "bake/effects/effects.h"
#include "bake/lab/sweep/report_page.h"
#include "bake/lab/sweep/tables.h"
#include "bake/pipeline/calibration/rates_cache.h"
#include "formats/opal/atomic_file.h"

namespace opaline::cli {
namespace {

using formats::AtomicFile;
using formats::ErrorKind;
using formats::make_error;

struct SweepCommand {
    SceneOptions scene;
    std::string folder, light = "sky:3,35";
    double seconds = 300;
    ProgressStyle progress = ProgressStyle::automatic;
};

// The folder of the results. One that was made here and is still empty goes again.
class OutputFolder {
  public:
    explicit OutputFolder(std::filesystem::path path) : path_(std::move(path)) {}
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;
    ~OutputFolder() {
        std::error_code ignored;
        if (created_) {
            std::filesystem::remove(path_, ignored);  // fails unless it is empty
        }
    }

    void create() {
        std::error_code error;
        if (std::filesystem::exists(path_, error) && !std::filesystem::is_directory(path_, error)) {
            refuse(make_error(ErrorKind::usage, path_.string(), "", "is a file, not a folder",
                              "choose another output"));
        }
        created_ = std::filesystem::create_directories(path_, error);
        if (error) {
            refuse(make_error(ErrorKind::resource, path_.string(), "",
                              "cannot be made: " + error.message(), "choose another output"));
        }
    }

  private:
    std::filesystem::path path_;
    bool created_ = false;
};

// Names of the first ones.
std::string list_left_out(const std::vector<bake::SkippedPoint>& skipped) {
    constexpr std::size_t kMost = 6;
    std::string list;
    for (std::size_t i = 0; i < std::min(kMost, skipped.size()); ++i) {
        list += (i > 0 ? "; " : "") + skipped[i].point.label;
    }
    return skipped.size() > kMost ? fmt::format("{} and {} more", list, skipped.size() - kMost)
                                  : list;
}

int run(const SweepCommand& options) {
    const bake::Clock::time_point start = bake::Clock::now();
    const std::atomic<bool>& interrupted = catch_interrupts();
    const auto options_of_bake = parse_effects(options.scene);
    // Of the knobs it starts from: what does not fit there fits nowhere.
    const auto knobs = require(bake::resolve_knobs(bake::all_effects(), options_of_bake));
    const auto imported = open_scene(options.scene, knobs, formats::CloudDetail::fields);
    OutputFolder folder(options.folder);
    folder.create();
    std::vector<OutputFile> outputs;
    for (const char* name : {"sweep.csv", "sweep.json", "report.html"}) {
        outputs.push_back({name, std::filesystem::path(options.folder) / name, {}});
    }
    require(check_outputs(outputs, imported.scene.inputs));
    std::vector<AtomicFile> files = create_outputs(outputs);
    bake::SweepOptions wanted;
    wanted.bake = options_of_bake;
    wanted.seconds = std::max(0.0, options.seconds - bake::seconds_since(start));
    wanted.light = options.light;
    wanted.rates = bake::find_machine_rates().rates;
    bake::Context context;
    context.threads = options.scene.bake.threads;
    context.cancel = &interrupted;
    context.cache = bake::cache_folder();
    const auto show = make_progress_printer(options.progress, "sweep");
    const auto result = require(bake::run_sweep(bake::all_effects(), imported.scene, wanted,
                                                context, [&](const bake::SweepStep& step) {
                                                    if (show)
                                                        show({"bakes", step.done, step.total});
                                                }));
    if (show) show({"sweep", 1, 1});
    const bake::SweepAnalysis analysis = bake::analyse_sweep(result);
    const auto json = bake::make_sweep_json(result, analysis);
    const auto page = require(bake::make_report_page(result, analysis, json));
    const std::string texts[] = {
        bake::make_sweep_csv(result, analysis),
        json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n", page};
    for (std::size_t i = 0; i < files.size(); ++i) {
        require(files[i].write(texts[i]));
    }
    commit_outputs(files);
    print_note(fmt::format(
        "{}: {} bake{} in {}{}; open {}", printable(options.folder), result.points.size(),
        result.points.size() == 1 ? "" : "s", format_seconds(result.seconds),
        result.skipped.empty() ? ""
                               : fmt::format("; left out, for reasons that the page has: {}",
                                             printable(list_left_out(result.skipped))),
        printable((std::filesystem::path(options.folder) / "report.html").string())));
    return kExitSuccess;
}

}  // namespace

void add_sweep_command(Program& program) {
    auto [command, options] = add_command<SweepCommand>(
        program, "sweep",
        "Bake a scene in many ways, and show what accuracy costs in time and bytes", run);
    add_subject_options(command, options.scene);
    command
        .add("-o,--output", "DIR", file_name(options.folder),
             "the folder for sweep.csv, sweep.json and report.html; made if missing")
        .required();
    command.add("--seconds", "S [300]", real_number(options.seconds, 1, 1e6),
                "time for all bakes and what they are compared with; what does not fit is left out "
                "and named");
    command.add("--light", "ENV [sky:3,35]", text(options.light),
                "of the page's pictures: " + light_help());
    add_progress_option(command, options.progress);
    command.footer("Example:\n  opaline sweep scene.glb -o sweep");
}

}  // namespace opaline::cli
