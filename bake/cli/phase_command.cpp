#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "bake/cli/command.h"
#include "bake/cli/droplet_options.h"
#include "bake/cli/json_output.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/phase_subject.h"
#include "bake/physics/phase_maps.h"
#include "bake/physics/phase_series.h"
#include "formats/media/limits.h"

namespace opaline::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PhaseCommand {
    PhaseChoice phase;
    std::string table_output;
    unsigned samples = 181;
    TextFormat format = TextFormat::json;
    Option g_option, rms_angle_option, table_option, samples_option;
};

constexpr unsigned kMostTerms = 25, kCubemapSize = 16;
constexpr std::size_t kSingularValues = 100;  ///< shown; the errors take in all of them

void check_options(const PhaseCommand& options) {
    using Type = PhaseType;
    struct Rule {
        const Option& option;
        PhaseType type;
        const char* type_name;
    };
    const Rule rules[] = {{options.g_option, Type::henyey_greenstein, "hg"},
                          {options.rms_angle_option, Type::gaussian, "gaussian"},
                          {options.table_option, Type::tabulated, "table"},
                          {options.phase.droplets.effective_radius_option, Type::mie, "mie"}};
    for (const auto& [option, type, type_name] : rules) {
        const bool given = option.is_given();
        if (given != (options.phase.type == type)) {
            refuse_usage(option.name(), given ? "this type has no such value" : "it is missing",
                         fmt::format("give it with --type {} alone", type_name));
        }
    }
    if (options.phase.type != PhaseType::mie) {
        for (const std::string& name : given_droplet_options(options.phase.droplets)) {
            refuse_usage(name, "this type has no such value", "give it with --type mie alone");
        }
    } else if (options.samples_option.is_given()) {
        refuse_usage("--samples", "this type has rows of its own",
                     "leave it out: they crowd where the function bends");
    }
}

/// Everything that is printed, in order.
Json describe(const PhaseSubject& subject, const bake::PhaseMaps& maps, unsigned samples) {
    Json all;
    all["phase"] = subject.json;
    all["mean_cosine"] = subject.series.lambda[1];
    if (!subject.error.is_null()) {
        all["error"] = subject.error;
    }
    Json& function = all["function"];
    std::vector<double> cosines = subject.cosines;
    for (unsigned i = 0; subject.cosines.empty() && i < samples; ++i) {
        const double angle = std::numbers::pi * (1 - i / (samples - 1.0));
        cosines.push_back(i == 0 ? -1 : i + 1 == samples ? 1 : std::cos(angle));
    }
    for (const double cosine : cosines) {
        function["cosine"].push_back(cosine);
        function["value"].push_back(subject.p(cosine));
    }
    all["lambda"] = subject.series.lambda;
    Json& rms = all["rms"];
    for (unsigned terms = 1; terms <= kMostTerms; ++terms) {
        rms["terms"].push_back(terms);
        rms["harmonics"].push_back(bake::phase_rms_relative(subject.series, terms));
        rms["harmonics_absolute"].push_back(bake::phase_rms(subject.series, terms));
        rms["svd"].push_back(bake::phase_rms_relative(maps, terms));
    }
    all["cubemap"] = kCubemapSize;
    all["row_error"] = maps.row_error;
    all["singular_values"] = std::vector<double>(maps.singular_value.begin(),
                                                 maps.singular_value.begin() + kSingularValues);
    return all;
}

void print_csv(const Json& all) {
    fmt::print("quantity,at,value\n");
    const auto print = [](const char* quantity, const Json& at, const Json& value) {
        for (std::size_t i = 0; i < value.size(); ++i) {
            const std::string place = at.is_null() ? std::to_string(i) : at[i].dump();
            fmt::print("{},{},{}\n", quantity, place, value[i].dump());
        }
    };
    print("p", all["function"]["cosine"], all["function"]["value"]);
    print("lambda", nullptr, all["lambda"]);
    for (const char* name : {"harmonics", "harmonics_absolute", "svd"}) {
        print(fmt::format("rms_{}", name).c_str(), all["rms"]["terms"], all["rms"][name]);
    }
    print("singular_value", nullptr, all["singular_values"]);
}

int run(const PhaseCommand& options) {
    check_options(options);
    if (!options.table_output.empty()) {
        const std::vector<std::filesystem::path> inputs(options.phase.table.empty() ? 0 : 1,
                                                        options.phase.table);
        const OutputFile output{"--table-output", options.table_output, {}};
        require(check_outputs({&output, 1}, inputs));
    }
    const auto subject = make_phase_subject(options.phase);
    const bake::PhaseMaps maps = bake::factor_phase(subject.p, kCubemapSize, 0);
    constexpr double kMostRowError = 0.01;
    if (maps.row_error > kMostRowError) {
        require(report_warnings({formats::make_warning(
            options.phase.table, "",
            fmt::format("the lobe is too narrow for a cube map of {} x {} texels, whose rows "
                        "integrate to 1 within {:.2g} only",
                        kCubemapSize, kCubemapSize, maps.row_error),
            "use the harmonics' errors, not those of the svd")}));
    }
    const Json all = describe(subject, maps, options.samples);
    if (!options.table_output.empty()) {
        require(write_phase_table(options.table_output, subject));
    }
    if (options.format == TextFormat::csv) {
        print_csv(all);
    } else {
        fmt::print("{}", json_text(all));
    }
    return kExitSuccess;
}

}  // namespace

void add_phase_command(Program& program) {
    using Type = PhaseType;
    auto [command, options] = add_command<PhaseCommand>(
        program, "phase", "Tabulate a phase function and say how many terms its factors need", run);
    command.add("--type",
                one_of(options.phase.type, {{"hg", Type::henyey_greenstein},
                                            {"isotropic", Type::isotropic},
                                            {"rayleigh", Type::rayleigh},
                                            {"gaussian", Type::gaussian},
                                            {"table", Type::tabulated},
                                            {"mie", Type::mie}}),
                "as in media files: formats/media/README.md");
    options.g_option = command.add("--g", "G",
                                   real_number(options.phase.g, -formats::media::kMaxMeanCosine,
                                               formats::media::kMaxMeanCosine),
                                   "mean cosine of hg, -0.99 to 0.99; above 0: forward");
    options.rms_angle_option = command.add(
        "--rms-angle", "A", real_number(options.phase.rms_angle, formats::media::kMinRmsAngle, 1),
        "root mean square angle of the gaussian, in radians, 0.001 to 1");
    options.table_option = command.add("--table", "FILE", file_name(options.phase.table),
                                       "measured function: lines of a cosine and a value, cosines "
                                       "ascending from -1 to 1, values relative");
    add_droplet_options(command, options.phase.droplets, true);
    options.samples_option =
        command.add("--samples", "N [181]", whole_number(options.samples, 2, 100001),
                    "angles at which the function is printed, equally spaced");
    command.add(
        "--table-output", "FILE", file_name(options.table_output),
        "also write the function as a table that a media file can name, with rows where it bends");
    add_format_options(command, options.format, "csv: lines of quantity,at,value");
    command.footer(
        "Prints p(cosine) per steradian, the cosine between propagation directions; lambda_l, its\n"
        "Legendre coefficients, p = sum (2 l + 1) / (4 pi) lambda_l P_l; the RMS error, over all\n"
        "pairs of directions, of the first 1 to 25 spherical harmonics (relative, and per\n"
        "steradian) and of as many terms of the singular value decomposition between the texels "
        "of\n"
        "a 6 x 16 x 16 cube map, weighted by solid angle; its 100 largest singular values.\n"
        "Type mie is the mean over droplets (--effective-radius, see `opaline mie --help`) at one\n"
        "wavelength, with rows where the function bends, and its numerical error; at several,\n"
        "the mean by scattered power, which takes the hard colours out of a glory.\n"
        "Example:\n  opaline phase --type hg --g 0.6 --format csv\n"
        "  opaline phase --type mie --effective-radius 7um --table-output droplets.txt\n"
        "  opaline phase --type mie --effective-radius 7um --wavelength 600nm,650nm,700nm "
        "--weights 1,2,1");
}

}  // namespace opaline::cli
