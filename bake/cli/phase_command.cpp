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
#include "bake/scattering/phase_maps.h"
#include "bake/scattering/phase_series.h"
#include "formats/media/limits.h"

namespace opaline::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PhaseCommand {
    PhaseChoice phase;
    std::string table_output;
    unsigned samples = 181;
    TextFormat format = TextFormat::json;
    CLI::Option *g_option = nullptr, *rms_angle_option = nullptr, *table_option = nullptr,
                *samples_option = nullptr;
};

constexpr unsigned kMostTerms = 25, kCubemapSize = 16;
constexpr std::size_t kSingularValues = 100;  ///< shown; the errors take in all of them

void check_options(const PhaseCommand& options) {
    using Type = PhaseType;
    struct Rule {
        const CLI::Option* option;
        const char* name;
        PhaseType type;
        const char* remedy;
    };
    const Rule rules[] = {
        {options.g_option, "--g", Type::henyey_greenstein, "give it with --type hg alone"},
        {options.rms_angle_option, "--rms-angle", Type::gaussian,
         "give it with --type gaussian alone"},
        {options.table_option, "--table", Type::tabulated, "give it with --type table alone"},
        {options.phase.droplets.effective_radius_option, "--effective-radius", Type::mie,
         "give it with --type mie alone"}};
    for (const Rule& rule : rules) {
        const bool given = rule.option->count() > 0, needed = options.phase.type == rule.type;
        if (given != needed) {
            refuse_usage(rule.name, given ? "this type has no such value" : "it is missing",
                         rule.remedy);
        }
    }
    if (options.phase.type != PhaseType::mie) {
        for (const std::string& name : given_droplet_options(options.phase.droplets)) {
            refuse_usage(name, "this type has no such value", "give it with --type mie alone");
        }
    } else if (options.samples_option->count() > 0) {
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

void add_phase_command(CLI::App& app, Job& job) {
    using Type = PhaseType;
    auto options = std::make_shared<PhaseCommand>();
    CLI::App* command = app.add_subcommand(
        "phase", "Tabulate a phase function and say how many terms its factors need");
    command->add_option("--type", options->phase.type, "as in media files: formats/media/README.md")
        ->transform(one_of<Type>({{"hg", Type::henyey_greenstein},
                                  {"isotropic", Type::isotropic},
                                  {"rayleigh", Type::rayleigh},
                                  {"gaussian", Type::gaussian},
                                  {"table", Type::tabulated},
                                  {"mie", Type::mie}}))
        ->option_text("hg|isotropic|rayleigh|gaussian|table|mie [hg]");
    options->g_option =
        command
            ->add_option("--g", options->phase.g,
                         "mean cosine of hg, -0.99 to 0.99; above 0: forward")
            ->check(real_number(-formats::media::kMaxMeanCosine, formats::media::kMaxMeanCosine))
            ->option_text("G");
    options->rms_angle_option =
        command
            ->add_option("--rms-angle", options->phase.rms_angle,
                         "root mean square angle of the gaussian, in radians, 0.001 to 1")
            ->check(real_number(formats::media::kMinRmsAngle, 1))
            ->option_text("A");
    options->table_option =
        command
            ->add_option("--table", options->phase.table,
                         "measured function: lines of a cosine and a value, cosines ascending from "
                         "-1 to 1, values relative")
            ->option_text("FILE");
    add_droplet_options(*command, options->phase.droplets, true);
    options->samples_option =
        command
            ->add_option("--samples", options->samples,
                         "angles at which the function is printed, equally spaced")
            ->transform(whole_number(2, 100001))
            ->option_text("N [181]");
    command
        ->add_option("--table-output", options->table_output,
                     "also write the function as a table that a media file can name, with rows "
                     "where it bends")
        ->check(file_name())
        ->option_text("FILE");
    add_format_options(*command, options->format, "csv: lines of quantity,at,value");
    command->footer(
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
    command->callback([options, &job] { job = [options] { return run(*options); }; });
}

}  // namespace opaline::cli
