#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/json_output.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "formats/opal/receiver_errors.h"

namespace opaline::cli {
namespace {

struct VerifyCommand {
    std::vector<std::string> paths;
    bool json = false;
};

struct Verdict {
    std::optional<formats::Error> fault;  ///< none: the file is sound
    int exit_code = kExitSuccess;
};

Verdict verify(const std::string& path) {
    // A missing file is bad input; a damaged file is the answer "no".
    auto file = formats::FileBytes::open(path);
    if (!file) {
        return {file.error(), exit_code_of(file.error())};
    }
    const auto loaded = formats::read_opal(file->bytes(), path, formats::Checks::full);
    if (!loaded) {
        const int code = exit_code_of(loaded.error());
        return {loaded.error(), code == kExitBadInput ? kExitNo : code};
    }
    if (const auto errors = formats::read_receiver_errors(file->bytes(), *loaded, path); !errors) {
        const int code = exit_code_of(errors.error());
        return {errors.error(), code == kExitBadInput ? kExitNo : code};
    }
    // A file without provenance is sound: nothing is computed from it.
    const std::string_view provenance = loaded->view.provenance;
    if (!provenance.empty() && !nlohmann::json::accept(provenance)) {
        return {formats::make_error(formats::ErrorKind::bad_input, path, "section PROV",
                                    "it is not JSON", "bake the file again"),
                kExitNo};
    }
    return {};
}

int run(const VerifyCommand& options) {
    int code = kExitSuccess;
    nlohmann::ordered_json results = nlohmann::ordered_json::array();
    for (const std::string& path : options.paths) {
        const Verdict verdict = verify(path);
        code = std::max(code, verdict.exit_code);
        nlohmann::ordered_json faults = nlohmann::ordered_json::array();
        if (verdict.fault) {
            report_error(*verdict.fault);
            for (const formats::Diagnostic& diagnostic : verdict.fault->diagnostics) {
                faults.push_back(format_diagnostic(diagnostic));
            }
        } else if (!options.json) {
            fmt::print("{}: sound\n", printable(path));
        }
        results.push_back({{"file", path}, {"sound", !verdict.fault}, {"errors", faults}});
    }
    if (options.json) {
        fmt::print("{}", json_text({{"files", results}}));
    }
    return code;
}

}  // namespace

void add_verify_command(Program& program) {
    auto [command, options] = add_command<VerifyCommand>(
        program, "verify", "Check .opal files: structure, checksums, ranges, finite numbers", run);
    command.add("file", "FILE.opal...", file_names(options.paths), "the .opal files").required();
    command.add_flag("--json", options.json, "print JSON: files[]{file,sound,errors[]}");
    command.footer(
        "Exit code 1: a file is damaged; 3: one is missing.\n"
        "Example:\n  opaline verify scene.opal");
}

}  // namespace opaline::cli
