#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bake/plan/rates.h"
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

/// $XDG_CACHE_HOME/opaline/calibration.json, or $HOME/.cache/opaline/calibration.json where the
/// variable is not set or not absolute. Empty where neither variable is set.
std::filesystem::path rates_path();

/// The rates in a file. Nothing if the file is missing, unreadable, damaged, or of another machine.
std::optional<Rates> read_rates(const std::filesystem::path& file, const MachineKey& machine);

/// Writes the rates to a file, whole or not at all, and creates its folder if necessary. Errors:
/// resource.
formats::Status write_rates(const std::filesystem::path& file, const MachineKey& machine,
                            const Rates& rates);

}  // namespace opaline::bake
