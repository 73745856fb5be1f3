#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"

namespace opaline::cli {
namespace {

int run(const std::string& path) {
    // A file that is not there is bad input; one that is there and damaged is the answer "no".
    auto file = formats::FileBytes::open(path);
    if (!file) {
        return report_error(file.error());
    }
    const auto loaded = formats::read_opal(file->bytes(), path, formats::Checks::full);
    if (!loaded) {
        const int code = report_error(loaded.error());
        return loaded.error().kind == formats::ErrorKind::bad_input ? kExitNo : code;
    }
    // A file without provenance is sound: nothing is computed from it.
    const std::string_view provenance = loaded->view.provenance;
    if (!provenance.empty() && !nlohmann::json::accept(provenance)) {
        report_error(formats::make_error(formats::ErrorKind::bad_input, path, "section PROV",
                                         "it is not JSON", "bake the file again"));
        return kExitNo;
    }
    fmt::print("{}: sound\n", path);
    return kExitSuccess;
}

}  // namespace

void add_verify_command(CLI::App& app, Job& job) {
    auto path = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand(
        "verify", "Check an .opal file: structure, checksums, ranges, finite numbers");
    command->add_option("file", *path, "the .opal file")->required()->option_text("FILE.opal");
    command->footer("Exit code 1: the file is damaged.\nExample:\n  opaline verify scene.opal");
    command->callback([path, &job] { job = [path] { return run(*path); }; });
}

}  // namespace opaline::cli
