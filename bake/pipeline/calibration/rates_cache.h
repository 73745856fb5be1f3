#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "bake/base/stage_log.h"
#include "bake/pipeline/cost_model.h"
#include "bake/plan/stage_work.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Moves the rates of each kind of stage toward what a bake took: log factor' = (1 - w) log factor
/// + w log (cpu_seconds / work), of all stages of the kind together, with w = max(1 / bakes, 1/8),
/// less in proportion below 0.1 s, where a stage's beginning is most of it. Stages are matched by
/// name, the last of each first: a pilot's last round has the knobs of the file, for which
/// `predicted` is. What took less than 5 ms says nothing, nor what took 20 times longer or shorter
/// than the constants say: its cause is not the machine, as where test lights are computed or read.
void learn_rates(std::span<const StageCost> predicted, const StageLog& ran, StageRates& rates);

/// The rates of this machine, and their source.
struct MachineRates {
    StageRates rates;
    std::string note;  ///< for reports
};

/// Reads what earlier bakes taught; a cache that is not there or damaged teaches nothing.
MachineRates find_machine_rates();

/// learn_rates, of the rates as they were found; the result is kept in the user's cache. A cache
/// that cannot be written stays as it is.
void learn_machine_rates(std::span<const StageCost> predicted, const StageLog& ran,
                         StageRates rates);

/// The key of a set of rates: processor, number of threads, program version.
struct MachineKey {
    std::string processor;
    unsigned threads = 1;
    std::string version;
};

/// The machine that the program runs on.
MachineKey this_machine();

/// The user's cache: $XDG_CACHE_HOME/opaline, or $HOME/.cache/opaline where the first is not set or
/// not absolute. Empty where there is neither.
std::filesystem::path cache_folder();

/// Where rates are kept: calibration.json in cache_folder(); empty where that is.
std::filesystem::path rates_path();

/// The rates in a file. Nothing if the file is missing, unreadable, damaged, or of another machine.
/// A damaged entry damages all.
std::optional<StageRates> read_rates(const std::filesystem::path& file, const MachineKey& machine);

/// Writes the rates to a file, whole or not at all, and creates its folder if necessary. Errors:
/// resource.
formats::Status write_rates(const std::filesystem::path& file, const MachineKey& machine,
                            const StageRates& rates);

}  // namespace opaline::bake
