#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "bake/cli/command.h"
#include "bake/cli/folder_output.h"
#include "bake/cli/inputs.h"
#include "bake/cli/interrupt.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/environment/builtin_environment.h"
#include "runtime/web/web_page.h"

namespace opaline::cli {
namespace {

struct ExportWebCommand {
    std::string path, folder;
    std::vector<std::string> lights;
    unsigned threads = 0;
};

std::vector<std::string> default_lights(const formats::AssetView& view) {
    std::vector<std::string> lights{"studio", "sky:3,35", "sky:5,8", "sun:-40,40"};
    if (!view.emitters.empty()) lights.emplace_back("black");
    return lights;
}

// The name that a page shows: a built-in as it is written, a file without its folder.
std::string name_of_light(const std::string& spec, const std::vector<runtime::PageLight>& before) {
    const std::string name =
        bake::is_builtin(spec) ? spec : std::filesystem::path(spec).filename().string();
    std::string unique = name;
    const auto is_taken = [&](const runtime::PageLight& light) { return light.name == unique; };
    for (int number = 2; std::any_of(before.begin(), before.end(), is_taken); ++number) {
        unique = fmt::format("{} ({})", name, number);
    }
    return unique;
}

std::vector<runtime::PageLight> open_lights(const std::vector<std::string>& specs) {
    std::vector<runtime::PageLight> lights;
    for (const std::string& spec : specs) {
        auto light = require(open_light(spec, 0));
        lights.push_back({name_of_light(spec, lights), std::move(light.environment)});
    }
    return lights;
}

int run(const ExportWebCommand& options) {
    const std::atomic<bool>& interrupted = catch_interrupts();
    require(check_folder(options.folder, runtime::is_page_file));
    for (const std::string& light : options.lights) {
        require(check_light(light));
    }
    const auto asset = require(open_asset(options.path));
    const formats::AssetView& view = asset.loaded.view;
    const auto lights = open_lights(options.lights.empty() ? default_lights(view) : options.lights);
    const auto page = require(
        runtime::make_web_page(view, lights, std::filesystem::path(options.path).stem().string(),
                               options.path, options.threads));
    if (interrupted.load()) {
        refuse(formats::make_error(formats::ErrorKind::interrupted, "", "", "interrupted",
                                   "nothing was written"));
    }
    std::vector<FolderFile> files;
    std::size_t bytes = 0;
    for (const runtime::PageFile& file : page) {
        files.push_back({file.name, file.text});
        bytes += file.text.size();
    }
    require(write_folder(options.folder, files));
    print_note(
        fmt::format("{}: {} with {} lights; open {}", printable(options.folder),
                    format_bytes(static_cast<double>(bytes)), lights.size(),
                    printable((std::filesystem::path(options.folder) / "index.html").string())));
    return kExitSuccess;
}

}  // namespace

void add_export_web_command(CLI::App& app, Job& job) {
    auto options = std::make_shared<ExportWebCommand>();
    CLI::App* command =
        app.add_subcommand("export-web", "Write a folder that shows an .opal file in any browser");
    add_asset_argument(*command, options->path);
    command
        ->add_option("-o,--output", options->folder,
                     "the folder; one that exists must be empty or an earlier page, which is "
                     "replaced")
        ->required()
        ->check(file_name())
        ->option_text("DIR");
    command
        ->add_option(
            "--light", options->lights,
            "a light that the page offers, may be given often; the first is shown first: " +
                light_help())
        ->option_text("ENV [studio, two skies, a sun]")
        ->take_all()
        ->allow_extra_args(false);
    add_threads_option(*command, options->threads, "0: one per core");
    command->footer(
        "The page needs WebGL 2, but no server and no network: open DIR/index.html from the disk.\n"
        "It shows what `render` does; light turns, cloud layers move with a time.\n"
        "After a '#', its address takes what `render` takes: light, rotate, time, exposure, eye, "
        "target,\n"
        "azimuth, elevation, distance, fov, emitter; the page keeps it up to date.\n\n"
        "Example:\n  opaline export-web statue.opal --light studio --light hall.exr -o page");
    command->callback([options, &job] { job = [options] { return run(*options); }; });
}

}  // namespace opaline::cli
