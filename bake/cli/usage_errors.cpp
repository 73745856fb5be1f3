#include "bake/cli/usage_errors.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numeric>

#include "bake/cli/messages.h"

namespace opaline::cli {
namespace {

// Levenshtein distance: insertions, deletions and replacements of one character.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

std::string suggest(std::string_view wanted, const std::vector<std::string>& names) {
    const std::string nearest = find_nearest(wanted, names);
    return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) {
        names.push_back(command->get_name());
    }
    return names;
}

// Of the command and of the program: "--output", "-o", ...
std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::App* app = &command; app != nullptr; app = app->get_parent()) {
        for (const CLI::Option* option : app->get_options()) {
            for (const std::string& name : option->get_lnames()) {
                names.push_back("--" + name);
            }
        }
    }
    return names;
}

// "--quality" of "--quality=best".
std::string_view option_part(std::string_view argument) {
    return argument.substr(0, argument.find('='));
}

std::string describe_unexpected(const CLI::App& command, const std::string& argument) {
    if (argument.size() > 1 && argument[0] == '-') {
        const std::string_view name = option_part(argument);
        return fmt::format("there is no option '{}'{}", shorten(name),
                           suggest(name, option_names(command)));
    }
    if (command.get_parent() == nullptr) return describe_unknown_command(command, argument);
    return fmt::format("'{}' is one argument too many", shorten(argument));
}

// Of options: "--output"; of arguments: "SCENE".
std::string display_name(const CLI::Option& option) {
    const bool is_positional = option.get_lnames().empty() && option.get_snames().empty();
    return is_positional ? option.get_option_text() : option.get_name();
}

std::string describe_missing(const CLI::App& command) {
    if (command.get_parent() == nullptr) return "a command is missing";
    std::string list;
    for (const CLI::Option* option : command.get_options()) {
        if (option->get_required() && option->count() == 0) {
            list += (list.empty() ? "" : " and ") + display_name(*option);
        }
    }
    return list + (list.find(" and ") == std::string::npos ? " is missing" : " are missing");
}

// A value too few or too many: CLI11 says which, but not in words.
std::string describe_mismatch(const CLI::App& command, const CLI::ParseError& error) {
    const std::string name =
        std::string(error.what()).substr(0, std::string(error.what()).find(':'));
    const CLI::Option* option = command.get_option_no_throw(name);
    const bool is_repeated = option != nullptr && option->results().size() > 1;
    return name + (is_repeated ? ": is given more than once" : ": its value is missing");
}

}  // namespace

std::string describe_unknown_command(const CLI::App& app, const std::string& name) {
    return fmt::format("there is no command '{}'{}", shorten(name),
                       suggest(name, command_names(app)));
}

std::string find_nearest(std::string_view wanted, const std::vector<std::string>& names) {
    std::string nearest;
    std::size_t best = wanted.size() / 3 + 2;  // typing errors, not other words
    for (const std::string& name : names) {
        if (const std::size_t distance = edit_distance(wanted, name); distance < best) {
            best = distance;
            nearest = name;
        }
    }
    return nearest;
}

std::string describe_usage_error(const CLI::App& app, const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const CLI::App& command = chosen.empty() ? app : *chosen.front();
    const std::vector<std::string> unexpected = app.remaining(true);
    // Not by get_name(): for unexpected arguments that is the command's.
    const auto is = [&](CLI::ExitCodes kind) {
        return error.get_exit_code() == static_cast<int>(kind);
    };
    using enum CLI::ExitCodes;
    std::string text = printable(error.what());
    if (!unexpected.empty() && (is(ExtrasError) || is(RequiredError))) {
        // An unknown option takes its value along.
        const auto is_option = [](const std::string& a) { return a.size() > 1 && a[0] == '-'; };
        const auto option = std::ranges::find_if(unexpected, is_option);
        text =
            describe_unexpected(command, option == unexpected.end() ? unexpected.front() : *option);
    } else if (is(RequiredError)) {
        text = describe_missing(command);
    } else if (is(ArgumentMismatch)) {
        text = describe_mismatch(command, error);
    } else if (is(ExcludesError)) {
        text = std::string(error.what());
        const std::size_t at = text.find(" excludes ");
        text = at == std::string::npos ? text : text.replace(at, 10, " cannot be given with ");
    }
    return fmt::format("{} (see `opaline{} --help`)", text,
                       chosen.empty() ? "" : " " + command.get_name());
}

}  // namespace opaline::cli
