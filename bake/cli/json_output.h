#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bake/cli/option_values.h"

namespace opaline::cli {

/// JSON as it is printed and reported, with a line feed at its end. ASCII only: names from files
/// can neither break it, where they are not UTF-8, nor steer a terminal.
inline std::string json_text(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// How a command that is all numbers prints them.
enum class TextFormat { json, csv };

/// `--format json|csv`, and `--json`, which says that what is printed by default is wanted.
inline void add_format_options(const Command& command, TextFormat& format,
                               const std::string& help) {
    const Option option = command.add(
        "--format", one_of(format, {{"json", TextFormat::json}, {"csv", TextFormat::csv}}), help);
    command
        .add_flag(
            "--json", [&format] { format = TextFormat::json; }, "the same as --format json")
        .excludes(option);
}

}  // namespace opaline::cli
