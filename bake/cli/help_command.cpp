#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "bake/cli/command.h"
#include "bake/cli/messages.h"
#include "bake/cli/usage_errors.h"

namespace opaline::cli {
namespace {

int print_help(const CLI::App& app, const std::string& name) {
    const auto commands = app.get_subcommands({});
    const auto found =
        std::ranges::find(commands, name, [](const CLI::App* c) { return c->get_name(); });
    if (!name.empty() && found == commands.end()) {
        refuse_usage("", describe_unknown_command(app, name), "see `opaline --help`");
    }
    // App::help() would explain the command that was given: this one.
    const CLI::App& subject = name.empty() ? app : **found;
    const std::string shown = app.get_name() + (name.empty() ? "" : " " + name);
    fmt::print("{}", app.get_formatter()->make_help(&subject, shown, CLI::AppFormatMode::Normal));
    return kExitSuccess;
}

}  // namespace

void add_help_command(CLI::App& app, Job& job) {
    auto name = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand("help", "Explain the program, or one of its commands");
    command->add_option("command", *name, "the command to explain; none: the program")
        ->option_text("COMMAND");
    command->footer("Example:\n  opaline help bake");
    command->callback(
        [name, &app, &job] { job = [name, &app] { return print_help(app, *name); }; });
}

}  // namespace opaline::cli
