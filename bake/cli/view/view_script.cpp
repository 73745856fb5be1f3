#include "bake/cli/view/view_script.h"

#include <algorithm>
#include <span>
#include <utility>

#include "bake/cli/view/script_commands.h"
#include "bake/cli/view/script_words.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;
using What = decltype(ScriptStep::what);

std::string usage_of(const ScriptCommand& command) {
    return std::string(command.name) + (command.arguments[0] != '\0' ? " " : "") +
           command.arguments;
}

formats::Result<What> parse_line(const std::vector<std::string>& words) {
    for (const ScriptCommand& command : script_commands()) {
        if (words[0] != command.name) continue;
        auto what = command.parse(std::span(words).subspan(1));
        if (what) return std::move(*what);
        return make_error(ErrorKind::bad_input, "", "", "expected " + usage_of(command),
                          command.help);
    }
    std::string names;
    for (const ScriptCommand& command : script_commands()) {
        names += (names.empty() ? "" : ", ") + std::string(command.name);
    }
    return make_error(ErrorKind::bad_input, "", "", "'" + words[0] + "' is no command",
                      "commands are " + names);
}

}  // namespace

formats::Result<std::vector<ScriptStep>> parse_script(std::string_view text,
                                                      const std::string& file) {
    std::vector<ScriptStep> steps;
    formats::Error faults{ErrorKind::bad_input, {}};
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const auto words = words_of(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
        if (words && words->empty()) continue;
        auto what = words ? parse_line(*words)
                          : make_error(ErrorKind::bad_input, "", "", "a quote is not closed",
                                       "close it on its line");
        if (what) {
            ScriptStep& step = steps.emplace_back();
            step.line = number;
            step.what = std::move(*what);
            continue;
        }
        formats::Diagnostic fault = what.error().diagnostics.front();
        fault.file = file;
        fault.where = "line " + std::to_string(number);
        faults.diagnostics.push_back(std::move(fault));
    }
    if (!faults.diagnostics.empty()) return faults;
    return steps;
}

std::string script_help() {
    constexpr std::size_t kColumn = 28;
    std::string help;
    for (const ScriptCommand& command : script_commands()) {
        std::string usage = "  " + usage_of(command);
        usage.resize(std::max(usage.size() + 1, kColumn), ' ');
        help += usage + command.help + "\n";
    }
    return help;
}

}  // namespace opaline::cli
