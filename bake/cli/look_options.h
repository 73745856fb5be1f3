#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "runtime/picture/tone_map.h"

namespace opaline::cli {

/// What `render` and `view` share besides the camera: where their options are put.
struct LookOptions {
    double& rotate_light;  ///< [degrees]
    std::string& terms;
    std::optional<float>& exposure;  ///< [EV]; nothing: chosen from the picture
    runtime::ToneMap& tone_map;
    std::optional<std::uint32_t>& coefficients;  ///< of a row
};

/// Those that other commands have as well; `otherwise`: what is without the option.
void add_rotate_light_option(CLI::App& command, double& degrees);
void add_exposure_option(CLI::App& command, std::optional<float>& exposure, const char* otherwise);

void add_look_options(CLI::App& command, const LookOptions& options);

}  // namespace opaline::cli
