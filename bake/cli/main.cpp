#include <fmt/core.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <system_error>

#include "bake/cli/command.h"

namespace opaline::cli {
namespace {

int run_program(int argc, char** argv) {
    CLI::App app(
        "Opaline bakes how light travels through a scene, so that it can be relit in real time.");
    app.name("opaline");
    app.require_subcommand(1);
    app.set_version_flag("--version", std::string("opaline ") + OPALINE_VERSION);
    app.get_formatter()->column_width(38);
    Job job;
    add_bake_command(app, job);
    add_plan_command(app, job);
    add_info_command(app, job);
    add_verify_command(app, job);
    add_relight_command(app, job);
    add_render_command(app, job);
    add_reference_command(app, job);
    add_compare_command(app, job);
    add_phase_command(app, job);
    add_sweep_command(app, job);
    add_example_command(app, job);
    app.footer(
        "Exit codes: 0 success; 1 the job ran and the answer is no; 2 bad usage; 3 bad input "
        "file;\n"
        "4 resource or I/O failure; 130 interrupted.\n"
        "Example:\n"
        "  opaline example statue -o scenes\n"
        "  opaline bake scenes/statue.gltf -o statue.opal\n"
        "  opaline render statue.opal --light studio -o statue.png\n"
        "`opaline COMMAND --help` explains a command.");
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& help) {
        return app.exit(help);  // prints what --help or --version asked for
    } catch (const CLI::ParseError& error) {
        const auto chosen = app.get_subcommands();
        fmt::print(stderr, "opaline: error: {} (see `opaline{} --help`)\n", error.what(),
                   chosen.empty() ? "" : " " + chosen.front()->get_name());
        return kExitUsage;
    }
    const int code = job();
    // Buffered data may still not fit where it goes.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        fmt::print(stderr, "opaline: error: standard output: cannot write: {}\n",
                   std::strerror(errno));
        return kExitResource;
    }
    return code;
}

}  // namespace
}  // namespace opaline::cli

int main(int argc, char** argv) {
    try {
        return opaline::cli::run_program(argc, argv);
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "opaline: error: out of memory (free some, or lower the knobs)\n");
    } catch (const std::system_error& error) {
        fmt::print(stderr, "opaline: error: {}\n", error.what());
    } catch (const std::exception& error) {
        fmt::print(stderr, "opaline: error: {} (this is a fault of Opaline: please report it)\n",
                   error.what());
    }
    return opaline::cli::kExitResource;
}
