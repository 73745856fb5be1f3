#include <CLI/CLI.hpp>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bake/cli/command.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/usage_errors.h"
#include "bake/cli/view/view_script.h"
#include "bake/lab/compare/relight_table.h"
#include "tests/fuzz/targets.h"

namespace opaline::fuzz {
namespace {

std::string_view text_of(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_finite(formats::Vec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// A state that `opaline render` can draw, whatever led to it.
void expect_drawable(const cli::ViewState& state) {
    hold(std::isfinite(state.fov) && state.fov > 0 && state.fov < 180, "field of view");
    hold(state.rotate_light >= 0 && state.rotate_light < 360, "angle of the light");
    hold(std::isfinite(state.time) && std::abs(state.time) <= 1e9, "time");
    hold(!state.exposure || std::abs(*state.exposure) <= 64, "exposure");
    hold(!state.coefficients || *state.coefficients >= 6, "coefficients");
    hold(state.split >= 0 && state.split <= 1, "split");
    hold(std::isfinite(state.difference_gain) && state.difference_gain >= 0, "gain");
    hold(std::isfinite(state.error_white) && state.error_white >= 0, "white of errors");
    hold(state.viewpoint && is_finite(state.viewpoint->eye) && is_finite(state.viewpoint->target) &&
             is_finite(state.viewpoint->up) && state.viewpoint->eye != state.viewpoint->target,
         "viewpoint");
    for (const cli::EmitterColor& emitter : state.emitters) {
        for (const float v : {emitter.color.r, emitter.color.g, emitter.color.b}) {
            hold(std::isfinite(v) && v >= 0, "colour of an emitter");
        }
    }
}

// Options of every kind of value that the program has.
struct AnyOptions {
    std::vector<double> list, lengths;
    std::vector<std::string> texts, files;
    double real = 0, above = 1, length = 0;
    std::uint64_t seed = 0, memory = 0;
    unsigned threads = 0;
    std::string path, terms;
    int choice = 0;
    bool flag = false;
};

void add_any_command(cli::Program& program, AnyOptions& to) {
    using namespace cli;
    const Command command = add_command(program, "any", "Takes everything", [] { return 0; });
    add_asset_argument(command, to.path);
    command.add("others", "FILE", file_names(to.files), "more files");
    command.add("--real", real_number(to.real, -1, 1), "a number");
    command.add("--above", number_above(to.above, 0, 180), "a number");
    command.add("--length", length(to.length, 1e-9, 1), "a length");
    command.add("--lengths", lengths(to.lengths, 1e-9, 1), "lengths");
    command.add("--list", real_numbers(to.list, 0, 1e9), "numbers");
    command.add("--text", texts(to.texts), "a text");
    command.add("--terms", term_list(to.terms), "terms");
    const Option fast = command.add(
        "--choice", one_of(to.choice, {{"none", 0}, {"fast", 1}, {"best", 2}}), "a name");
    command.add_flag("-f,--flag", to.flag, "a flag").excludes(fast);
    add_threads_option(command, to.threads);
    add_seed_option(command, to.seed, "of random numbers");
    add_memory_option(command, to.memory);
}

void expect_within_bounds(const AnyOptions& options) {
    hold(std::abs(options.real) <= 1, "a number within its bounds");
    hold(options.above > 0 && options.above <= 180, "a number within its bounds");
    hold(options.length == 0 || (options.length >= 1e-9 && options.length <= 1), "a length");
    for (const double value : options.list) {
        hold(value >= 0 && value <= 1e9, "a number of a list within its bounds");
    }
    hold(options.choice >= 0 && options.choice <= 2, "a choice");
    hold(!options.path.empty(), "the path of a file is not empty");
}

}  // namespace

void run_view_script(std::span<const std::byte> bytes) {
    const auto steps = cli::parse_script(text_of(bytes), "s.txt");
    if (!steps) {
        for (const formats::Diagnostic& fault : steps.error().diagnostics) {
            hold(fault.where.starts_with("line "), "faults name their lines");
        }
        return;
    }
    cli::ViewState state;
    state.file = "a.opal";
    state.viewpoint = cli::Viewpoint{{0, 0, 4}, {0, 0, 0}};
    for (const cli::ScriptStep& step : *steps) {
        if (const auto* change = std::get_if<cli::StateChange>(&step.what)) {
            (*change)(state);
            if (!state.viewpoint) state.viewpoint = cli::Viewpoint{{0, 0, 4}, {0, 0, 0}};
        }
        if (const auto* emitter = std::get_if<cli::EmitterChange>(&step.what)) {
            cli::set_emitter(state, emitter->name, emitter->color);
        }
        expect_drawable(state);
    }
    hold(!cli::render_line(state, state.file, *state.viewpoint, "a.png").empty(), "its line");
}

void run_relight_table(std::span<const std::byte> bytes) {
    const auto rows = bake::decode_relight_csv(bytes, "t.csv");
    if (!rows) {
        hold(rows.error().diagnostics.front().where.starts_with("line "), "faults name their line");
        return;
    }
    for (const bake::RelightRow& row : *rows) {
        for (const float v : {row.radiance.r, row.radiance.g, row.radiance.b}) {
            hold(std::isfinite(v), "radiance is finite");
        }
    }
}

void run_command_line(std::span<const std::byte> bytes) {
    std::vector<std::string> words{"opaline"};
    std::string word;
    for (const std::byte byte : bytes) {
        const char c = static_cast<char>(byte);
        if (c != '\0' && c != '\n') {
            word += c;
            continue;
        }
        words.push_back(std::exchange(word, {}));
    }
    words.push_back(word);
    std::vector<const char*> argv;
    for (const std::string& w : words) {
        argv.push_back(w.c_str());
    }
    CLI::App app("test");
    app.name("opaline");
    app.require_subcommand(1);
    app.set_version_flag("-v,--version", "1");
    app.fallthrough();
    cli::Program program{app};
    AnyOptions options;
    add_any_command(program, options);
    try {
        app.parse(static_cast<int>(argv.size()), argv.data());
        expect_within_bounds(options);
    } catch (const CLI::Success&) {
        (void)app.help();
    } catch (const CLI::ParseError& error) {
        const std::string fault = cli::describe_usage_error(app, error);
        hold(!fault.empty(), "an error says what is wrong");
        hold(fault.find_first_of("\x1b\x07\r") == std::string::npos,
             "nothing from the command line reaches the terminal raw");
    }
}

}  // namespace opaline::fuzz
