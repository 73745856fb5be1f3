#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>

#include "bake/cli/view/view_script.h"

namespace opaline::cli {

/// A command of a script.
struct ScriptCommand {
    const char* name;
    const char* arguments;  ///< as help texts have them
    const char* help;
    /// From the words behind the name; nothing: they are not what the command takes.
    std::function<std::optional<decltype(ScriptStep::what)>(std::span<const std::string> words)>
        parse;
};

/// All of them, in the order of help texts.
std::span<const ScriptCommand> script_commands();

}  // namespace opaline::cli
