#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bake/plan/stage_rates.h"
#include "formats/opal/result.h"

namespace opaline::bake {

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
