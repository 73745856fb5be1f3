#include "bake/cli/program.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <system_error>

#include "bake/cli/command.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/usage_errors.h"
#include "bake/pipeline/provenance.h"
#include "formats/opal/asset.h"

namespace opaline::cli {
namespace {

#ifdef OPALINE_HAS_GL
constexpr bool kHasGl = true;
#else
constexpr bool kHasGl = false;
#endif
#ifdef __clang__
constexpr const char* kCompiler = "clang " __clang_version__;
#else
constexpr const char* kCompiler = "g++ " __VERSION__;
#endif

std::string describe_version() {
    return fmt::format(
        "opaline {}\n.opal files   version {}\nray tracer    {}\nbuild         {}, {}\n"
        "OpenGL        {}",
        OPALINE_VERSION, formats::kOpalVersion, bake::ray_tracer_name(), OPALINE_BUILD_TYPE,
        kCompiler, kHasGl ? "yes" : "no: render draws on the CPU");
}

// `name`: of a command; empty: the program.
int print_help(const CLI::App& app, const std::string& name) {
    const auto commands = app.get_subcommands({});
    const auto found = std::ranges::find(commands, name, &CLI::App::get_name);
    if (!name.empty() && found == commands.end()) {
        refuse_usage("", describe_unknown_command(app, name), "see `opaline --help`");
    }
    // App::help() would explain the command that was given: this one.
    const CLI::App& subject = name.empty() ? app : **found;
    const std::string shown = app.get_name() + (name.empty() ? "" : " " + name);
    fmt::print("{}", app.get_formatter()->make_help(&subject, shown, CLI::AppFormatMode::Normal));
    return kExitSuccess;
}

void add_help_command(Program& program) {
    auto name = std::make_shared<std::string>();
    const Command command =
        add_command(program, "help", "Explain the program, or one of its commands",
                    [name, &program] { return print_help(program.app, *name); });
    command.add("command", "COMMAND", text(*name), "the command to explain; none: the program");
    command.footer("Example:\n  opaline help bake");
}

// Buffered data may still not fit where it goes.
int end_output(int code) {
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    print_to_stderr(
        fmt::format("opaline: error: standard output: cannot write: {}\n", std::strerror(errno)));
    return kExitResource;
}

int run_commands(int argc, const char* const* argv) {
    CLI::App app(
        "Opaline bakes how light travels through a scene, so that it can be relit in real time.");
    app.name("opaline");
    app.require_subcommand(1);
    app.set_version_flag("-v,--version", describe_version);
    MessageOptions messages;
    app.fallthrough();  // the program's options stand before or after the command
    app.add_flag("--strict", messages.strict,
                 "warnings are errors: nothing is written, exit code 3");
    app.add_flag("--quiet", messages.quiet, "print errors only: no warnings, summary or progress");
    app.get_formatter()->column_width(38);
    Program program{app};
    // In the order in which they are met.
    for (const auto add :
         {add_example_command, add_bake_command, add_render_command,
#ifdef OPALINE_HAS_GL
          add_view_command,
#endif
          add_export_web_command, add_export_gltf_command, add_help_command, add_plan_command,
          add_info_command, add_verify_command, add_relight_command, add_reference_command,
          add_compare_command, add_mie_command, add_phase_command, add_slab_command,
          add_sweep_command}) {
        add(program);
    }
    app.footer(
        "Exit codes: 0 success; 1 the job ran and the answer is no; 2 bad usage; 3 bad input "
        "file;\n"
        "4 resource or I/O failure; 130 interrupted.\n"
        "Example:\n"
        "  opaline example statue\n"
        "  opaline bake statue/statue.gltf -o statue.opal\n"
        "  opaline render statue.opal -o statue.png\n"
        "`opaline help COMMAND` explains a command.");
    for (CLI::App* command : app.get_subcommands({})) {
        command->footer(command->get_footer() +
                        "\nEvery command also takes --strict and --quiet (see `opaline --help`).");
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return end_output(app.exit(help));  // prints what --help or --version asked for
    } catch (const CLI::ParseError& error) {
        print_to_stderr("opaline: error: " + describe_usage_error(app, error) + "\n");
        return kExitUsage;
    }
    set_message_options(messages);
    int code = kExitSuccess;
    try {
        code = program.job();
    } catch (const Refusal& refusal) {
        code = report_error(refusal.error);
    }
    return end_output(code);
}

}  // namespace

int run_program(int argc, const char* const* argv) {
    try {
        return run_commands(argc, argv);
    } catch (const std::bad_alloc&) {
        print_to_stderr("opaline: error: out of memory (free some, or lower the knobs)\n");
    } catch (const std::system_error& error) {
        print_to_stderr(fmt::format("opaline: error: {}\n", printable(error.what())));
    } catch (const std::exception& error) {
        print_to_stderr(
            fmt::format("opaline: error: {} (this is a fault of Opaline: please report it)\n",
                        printable(error.what())));
    }
    return kExitResource;
}

}  // namespace opaline::cli
