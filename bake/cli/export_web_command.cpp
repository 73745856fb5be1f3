#include <fcntl.h>
#include <fmt/core.h>

#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "bake/base/interrupted.h"
#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/progress.h"
#include "bake/lights/builtin_environment.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/result.h"
#include "runtime/web/web_page.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;
using formats::Status;

Status refuse_write(const std::filesystem::path& folder, const char* doing) {
    return make_error(ErrorKind::resource, folder.string(), "",
                      std::string("cannot ") + doing + ": " + std::strerror(errno),
                      "choose a folder you may write to");
}

// Removes the folder unless it has become the output.
class TemporaryOutput {
  public:
    explicit TemporaryOutput(const std::filesystem::path& parent)
        : path_((parent / ".opaline-XXXXXX").string()) {
        if (::mkdtemp(path_.data()) == nullptr) path_.clear();
    }
    TemporaryOutput(const TemporaryOutput&) = delete;
    TemporaryOutput& operator=(const TemporaryOutput&) = delete;
    ~TemporaryOutput() {
        std::error_code ignored;
        if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
    }

    const std::string& path() const { return path_; }  ///< empty: it could not be made
    void keep() { path_.clear(); }

  private:
    std::string path_;
};

// As a folder that mkdir makes.
void set_usual_mode(const std::string& folder) {
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::chmod(folder.c_str(), 0777 & ~mask);
}

void sync_folder(const std::filesystem::path& folder) {
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

// Puts the folder `fresh` in the place of `target`; what stood there has then the name `fresh`.
bool put_in_place(const std::string& fresh, const std::string& target) {
    if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) {
        return true;
    }
    if (errno != EINVAL && errno != ENOSYS) return false;
    const std::string old = fresh + "-old";
    if (::rename(target.c_str(), old.c_str()) != 0) return false;
    if (::rename(fresh.c_str(), target.c_str()) != 0) {
        const int reason = errno;
        ::rename(old.c_str(), target.c_str());
        errno = reason;
        return false;
    }
    return ::rename(old.c_str(), fresh.c_str()) == 0;
}

// Refuses a folder that write_folder would not replace: a file of that name, or a folder that
// holds anything which `is_ours` does not know by its name. Errors: usage.
Status check_folder(const std::filesystem::path& folder,
                    const std::function<bool(std::string_view)>& is_ours) {
    std::error_code error;
    const auto status = std::filesystem::status(folder, error);
    if (!std::filesystem::exists(status)) return formats::ok_status();
    if (!std::filesystem::is_directory(status)) {
        return make_error(ErrorKind::usage, folder.string(), "", "is a file, not a folder",
                          "choose another output");
    }
    std::filesystem::directory_iterator entries(folder, error);
    for (; !error && entries != std::filesystem::directory_iterator(); entries.increment(error)) {
        const std::string name = entries->path().filename().string();
        if (entries->is_regular_file(error) && is_ours(name)) continue;
        return make_error(ErrorKind::usage, folder.string(), "",
                          "holds '" + name + "', and would be replaced as a whole",
                          "choose a folder that is new, empty, or an earlier output");
    }
    if (error) {
        return make_error(ErrorKind::resource, folder.string(), "",
                          "cannot be read: " + error.message(), "choose another output");
    }
    return formats::ok_status();
}

// Writes the files to a folder beside it, syncs them, and gives that the folder's name; what stood
// there before is removed afterwards. Links are followed. On a file system that cannot exchange
// two folders, none of that name exists for a moment.
// Errors: resource; nothing has changed then.
Status write_folder(const std::filesystem::path& folder, std::span<const runtime::PageFile> files) {
    std::filesystem::path target = formats::resolve_links(folder);
    if (!target.has_filename()) target = target.parent_path();  // DIR/
    std::error_code error;
    std::filesystem::create_directories(target.parent_path(), error);
    TemporaryOutput fresh(target.parent_path());
    if (fresh.path().empty()) return refuse_write(folder, "make it");
    for (const runtime::PageFile& file : files) {
        auto written = formats::write_file_atomically(
            std::filesystem::path(fresh.path()) / file.name, file.text);
        if (!written) return written;
    }
    set_usual_mode(fresh.path());
    sync_folder(fresh.path());
    if (std::filesystem::exists(target, error)) {
        if (!put_in_place(fresh.path(), target.string())) return refuse_write(folder, "replace it");
    } else {
        if (::rename(fresh.path().c_str(), target.c_str()) != 0) {
            return refuse_write(folder, "name it");
        }
        fresh.keep();
    }
    sync_folder(target.parent_path());
    return formats::ok_status();
}

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
        auto light = open_light(spec, 0);
        lights.push_back({name_of_light(spec, lights), std::move(light.environment)});
    }
    return lights;
}

int run(const ExportWebCommand& options) {
    const std::atomic<bool>& interrupted = catch_interrupts();
    require(check_folder(options.folder, runtime::is_page_file));
    for (const std::string& light : options.lights) {
        check_light(light);
    }
    const auto asset = require(open_asset(options.path));
    const formats::AssetView& view = asset.loaded.view;
    const auto lights = open_lights(options.lights.empty() ? default_lights(view) : options.lights);
    const auto page = require(
        runtime::make_web_page(view, lights, std::filesystem::path(options.path).stem().string(),
                               options.path, options.threads));
    if (interrupted.load()) refuse(bake::interrupted());
    std::size_t bytes = 0;
    for (const runtime::PageFile& file : page) {
        bytes += file.text.size();
    }
    require(write_folder(options.folder, page));
    print_note(
        fmt::format("{}: {} with {} lights; open {}", printable(options.folder),
                    format_bytes(static_cast<double>(bytes)), lights.size(),
                    printable((std::filesystem::path(options.folder) / "index.html").string())));
    return kExitSuccess;
}

}  // namespace

void add_export_web_command(Program& program) {
    auto [command, options] = add_command<ExportWebCommand>(
        program, "export-web", "Write a folder that shows an .opal file in any browser", run);
    add_asset_argument(command, options.path);
    command
        .add("-o,--output", "DIR", file_name(options.folder),
             "the folder; one that exists must be empty or an earlier page, which is replaced")
        .required();
    command.add("--light", "ENV [studio, two skies, a sun]", texts(options.lights),
                "a light that the page offers, may be given often; the first is shown first: " +
                    light_help());
    add_threads_option(command, options.threads, "0: one per core");
    command.footer(
        "The page needs WebGL 2, but no server and no network: open DIR/index.html from the disk.\n"
        "It shows what `render` does; light turns, cloud layers move with a time.\n"
        "After a '#', its address takes what `render` takes: light, rotate, time, exposure, eye, "
        "target,\n"
        "azimuth, elevation, distance, fov, emitter; the page keeps it up to date.\n\n"
        "Example:\n  opaline export-web statue.opal --light studio --light hall.exr -o page");
}

}  // namespace opaline::cli
