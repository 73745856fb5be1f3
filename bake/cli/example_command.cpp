#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "bake/cli/command.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/usage_errors.h"
#include "bake/lab/example/example_scenes.h"
#include "bake/lights/builtin_environment.h"
#include "formats/image/exr.h"

namespace opaline::cli {
namespace {

struct ExampleCommand {
    std::string name, folder;
    bool list = false;
};

int list_all() {
    fmt::print("Scenes:\n");
    for (const bake::ExampleInfo& example : bake::list_examples()) {
        fmt::print("  {:<14} {}\n", example.name, example.summary);
    }
    fmt::print("Lights (written as OpenEXR; also names for --light):\n{}",
               bake::list_builtin_environments());
    return kExitSuccess;
}

// A sun of half a degree wants a finer map than soft lights do.
std::filesystem::path write_light(const std::string& spec, const std::filesystem::path& folder) {
    auto environment = require(bake::make_environment(spec));
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
        refuse(formats::make_error(formats::ErrorKind::resource, folder.string(), "",
                                   "cannot create the folder: " + error.message(),
                                   "choose a folder you may write to"));
    }
    std::string file = spec;
    std::replace_if(
        file.begin(), file.end(), [](char c) { return c == ':' || c == ','; }, '-');
    const std::filesystem::path path = folder / (file + ".exr");
    const std::uint32_t height = environment.discs.empty() ? 512 : 2048;
    require(formats::write_exr(path, bake::rasterise_lat_long(environment, 2 * height, height)));
    return path;
}

// The scene of that name, else the one that it may be a slip of; empty: none.
std::string nearest_example(const std::string& name) {
    std::vector<std::string> names;
    for (const bake::ExampleInfo& example : bake::list_examples()) {
        names.emplace_back(example.name);
    }
    for (const char* light : {"white", "black", "studio"})
        names.emplace_back(light);
    return find_nearest(name, names);
}

int run(const ExampleCommand& options) {
    if (options.list) return list_all();
    if (options.name.empty()) {
        refuse_usage("example", "a name is needed", "opaline example --list");
    }
    if (bake::is_builtin(options.name)) {
        const auto path = write_light(options.name, options.folder.empty() ? "." : options.folder);
        fmt::print("{}\n", path.string());
        return kExitSuccess;
    }
    const std::string nearest = nearest_example(options.name);
    if (nearest != options.name) {
        refuse_usage("", "there is no example '" + shorten(options.name) + "'",
                     (nearest.empty() ? "" : "did you mean '" + nearest + "'? ") +
                         std::string("opaline example --list names them"));
    }
    const auto files = require(
        bake::write_example(options.name, options.folder.empty() ? options.name : options.folder));
    for (const std::filesystem::path& file : files) {
        fmt::print("{}\n", file.string());
    }
    return kExitSuccess;
}

}  // namespace

void add_example_command(Program& program) {
    auto [command, options] = add_command<ExampleCommand>(
        program, "example", "Write a bundled example scene or light; nothing is downloaded", run);
    command.add("name", "NAME", text(options.name), "a scene or a light of the list");
    command.add("-o,--output", "DIR", file_name(options.folder),
                "folder to write to, created if absent; default: one named after the scene, the "
                "current one for a light");
    command.add_flag("--list", options.list, "say what there is");
    command.footer("Example:\n  opaline example statue\n  opaline example studio -o lights");
}

}  // namespace opaline::cli
