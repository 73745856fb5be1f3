#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bake/cli/command.h"
#include "bake/cli/droplet_options.h"
#include "bake/cli/json_output.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/physics/mie/angular_table.h"
#include "bake/physics/phase.h"
#include "bake/physics/phase_maps.h"
#include "bake/physics/phase_series.h"
#include "formats/media/limits.h"
#include "formats/media/read_phase_table.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/result.h"

namespace opaline::cli {
namespace {

/// The types of media files, and droplets, which become a table there.
enum class PhaseType { henyey_greenstein, isotropic, rayleigh, gaussian, tabulated, mie };

/// What options name: of the type's own values the others are not read.
struct PhaseChoice {
    PhaseType type = PhaseType::henyey_greenstein;
    double g = std::nan(""), rms_angle = std::nan("");  ///< rms_angle in radians
    std::string table;                                  ///< a file
    DropletOptions droplets;
};

/// The function itself, its series, and the object that names it in a media file (of droplets:
/// their parameters).
struct PhaseSubject {
    std::function<double(double)> p;  ///< of the cosine [1/sr]
    bake::PhaseSeries series;
    nlohmann::ordered_json json;
    /// Rows of its own, ascending from -1 to 1, in print and in --table-output; empty: equal
    /// angles, and rows that are chosen.
    std::vector<double> cosines = {}, table_cosines = {};
    nlohmann::ordered_json error = nullptr;  ///< numerical
};

using formats::PhaseFunction;

constexpr unsigned kSeriesDegrees = 32;
/// Rows of a table: what is left out is within this of the line between its neighbours, relative.
constexpr double kRowTolerance = 2e-3;

PhaseSubject make_droplet_subject(const DropletOptions& options) {
    const auto& given = options.substance.wavelengths;
    const std::vector<double> wavelengths = given.empty() ? std::vector{550 / 1e9} : given;
    const auto weights = weights_of(options.substance, wavelengths.size());
    auto optics = average_droplets(options, wavelengths);
    const bake::DropletOptics droplets =
        optics.size() == 1 ? optics.front() : bake::mix_wavelengths(optics, weights);
    PhaseSubject subject;
    subject.json = {{"type", "mie"},
                    {"wavelength_m", droplets.wavelength},
                    {"index", {droplets.index.real(), droplets.index.imag()}}};
    if (wavelengths.size() > 1) {
        subject.json["wavelengths_m"] = wavelengths;
        subject.json["weights"] = weights;
    }
    subject.json.update(describe_droplets(options.droplets));
    subject.error = describe_error(droplets);
    subject.series = bake::expand_table(droplets.phase, kSeriesDegrees);
    const std::vector<double> angles = bake::thin_table(droplets.phase, kRowTolerance).angle;
    for (auto angle = angles.rbegin(); angle != angles.rend(); ++angle) {
        subject.cosines.push_back(std::cos(*angle));
    }
    subject.table_cosines = subject.cosines;
    subject.p = [phase = droplets.phase](double cosine) {
        return bake::eval_table(phase, std::acos(std::clamp(cosine, -1.0, 1.0)));
    };
    return subject;
}

/// Ascending, from -1 to 1, each in single precision and once: the reader of tables keeps no more.
std::vector<double> round_cosines(std::vector<double> cosines) {
    for (double& cosine : cosines) {
        cosine = static_cast<double>(static_cast<float>(cosine));
    }
    cosines.erase(std::unique(cosines.begin(), cosines.end()), cosines.end());
    return cosines;
}

/// Rows that crowd where the function bends. They are chosen among angles in steps of 0.2 % from
/// both ends on, where peaks are.
std::vector<double> choose_cosines(const std::function<double(double)>& p) {
    constexpr double kFirst = 1e-4, kStep = 1.002;  // smaller angles have the rounded cosine 1
    std::vector<double> cosines{-1};
    for (double angle = kFirst; angle < std::numbers::pi / 2; angle *= kStep) {
        cosines.push_back(-std::cos(angle));
    }
    for (std::size_t i = cosines.size(); i-- > 0;) {
        cosines.push_back(-cosines[i]);
    }
    // Below, values would take hundreds of rows and make no difference.
    constexpr double kLeast = 1e-9;
    bake::AngularTable table;
    for (const double cosine : round_cosines(std::move(cosines))) {
        const double value = p(cosine);
        table.angle.push_back(std::acos(-cosine));  // ascending
        table.value.push_back(value < kLeast ? 0 : value);
    }
    std::vector<double> chosen;
    for (const double angle : bake::thin_table(table, kRowTolerance).angle) {
        chosen.push_back(-std::cos(angle));
    }
    return round_cosines(std::move(chosen));
}

/// Errors: of the table's reader, of droplets as `average_droplets`.
PhaseSubject make_phase_subject(const PhaseChoice& choice) {
    using Type = PhaseType;
    if (choice.type == PhaseType::mie) return make_droplet_subject(choice.droplets);
    if (choice.type == Type::henyey_greenstein) {
        const double g = choice.g;  // not rounded to the single precision of PhaseFunction
        return PhaseSubject{[g](double cosine) { return bake::henyey_greenstein(cosine, g); },
                            bake::expand_henyey_greenstein(g, kSeriesDegrees),
                            {{"type", "hg"}, {"g", g}}};
    }
    PhaseFunction phase;
    nlohmann::ordered_json json;
    if (choice.type == Type::gaussian) {
        phase.type = PhaseFunction::Type::gaussian;
        phase.rms_angle = static_cast<float>(choice.rms_angle);
        json = {{"type", "gaussian"}, {"rms_angle", choice.rms_angle}};
    } else if (choice.type == Type::tabulated) {
        phase = require(formats::read_phase_table(choice.table));
        json = {{"type", "table"}, {"file", choice.table}};
    } else if (choice.type == Type::rayleigh) {
        phase.type = PhaseFunction::Type::rayleigh;
        json = {{"type", "rayleigh"}};
    } else {
        phase.type = PhaseFunction::Type::isotropic;
        json = {{"type", "isotropic"}};
    }
    const bake::PhaseDensity density = bake::make_phase_density(phase);
    PhaseSubject subject{[density](double cosine) { return bake::eval_phase(density, cosine); },
                         bake::expand_phase(phase, kSeriesDegrees), std::move(json)};
    subject.table_cosines.assign(phase.cosine.begin(), phase.cosine.end());
    return subject;
}

/// A table as media files name them (formats/media/README.md), which has the function back within
/// 0.2 %. Errors: as write_file_atomically.
formats::Status write_phase_table(const std::string& path, const PhaseSubject& subject) {
    std::string text = "cosine value\n";
    for (const double cosine : subject.table_cosines.empty()
                                   ? choose_cosines(subject.p)
                                   : round_cosines(subject.table_cosines)) {
        text += fmt::format("{} {}\n", cosine, subject.p(cosine));
    }
    return formats::write_file_atomically(path, text);
}

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
