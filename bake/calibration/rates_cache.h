#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bake/plan/rates.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// What measured rates hold for: this processor, as many threads, and this program.
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

/// The rates in a file; nothing if it is not there, not readable, damaged, or not of this machine.
std::optional<Rates> read_rates(const std::filesystem::path& file, const MachineKey& machine);

/// Puts the rates into a file, whole or not at all; its folder is made if need be. Errors:
/// resource.
formats::Status write_rates(const std::filesystem::path& file, const MachineKey& machine,
                            const Rates& rates);

}  // namespace opaline::bake
