#include <fmt/core.h>

#include <algorithm>
#include <complex>
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
#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/mie/sphere_scattering.h"

namespace opaline::cli {
namespace {

using Json = nlohmann::ordered_json;

struct MieCommand {
    DropletOptions droplets;
    double size_parameter = 0, radius = 0;  // radius [m]
    std::string forward_angle = "auto";     // [degrees]
    TextFormat format = TextFormat::json;
    Option size_parameter_option, radius_option, density_option, forward_angle_option;
};

void check_options(const MieCommand& options) {
    const DropletOptions& droplets = options.droplets;
    const bool by_size = options.size_parameter_option.is_given();
    const bool by_radius = options.radius_option.is_given();
    const bool by_droplets = droplets.effective_radius_option.is_given();
    if (by_size + by_radius + by_droplets != 1) {
        refuse_usage("mie",
                     by_size || by_radius || by_droplets
                         ? "one sphere or one distribution is computed, not several"
                         : "nothing to compute",
                     "give one of --size-parameter, --radius and --effective-radius");
    }
    if (by_size && droplets.substance.wavelength_option.is_given()) {
        refuse_usage("--wavelength", "a size parameter holds the wavelength already",
                     "give it with --radius or --effective-radius");
    }
    if (by_size && options.droplets.substance.index.empty()) {
        refuse_usage("--index", "it is missing",
                     "a size parameter has no wavelength to look it up at");
    }
    if (by_radius && droplets.substance.wavelengths.size() > 1) {
        refuse_usage("--wavelength", "one sphere takes one", "give --effective-radius");
    }
    if (by_droplets) return;
    for (const Option& option :
         {droplets.gamma_option, droplets.size_step_option, droplets.threads_option,
          options.density_option, options.forward_angle_option}) {
        if (option.is_given()) {
            refuse_usage(option.name(), "one sphere has no such value",
                         "give it with --effective-radius alone");
        }
    }
}

Json index_json(std::complex<double> index) {
    return {index.real(), index.imag()};
}

Json describe_sphere(const MieCommand& options) {
    Json all;
    double x = options.size_parameter, wavelength = 0;
    const bool by_radius = options.radius_option.is_given();
    if (by_radius) {
        const auto& given = options.droplets.substance.wavelengths;
        wavelength = given.empty() ? 550 / 1e9 : given.front();
        x = 2 * std::numbers::pi * options.radius / wavelength;
        all["radius_m"] = options.radius;
        all["wavelength_m"] = wavelength;
    }
    const auto index = index_at(options.droplets.substance, wavelength);
    require(bake::check_sphere(x, index));
    const bake::MieEfficiencies q = bake::sphere_efficiencies(x, index);
    all["size_parameter"] = x;
    all["index"] = index_json(index);
    all["q_ext"] = q.q_ext;
    all["q_sca"] = q.q_sca;
    all["q_back"] = q.q_back;
    all["q_abs"] = q.q_abs;
    all["g"] = q.g;
    return all;
}

/// The angle of the forward peak for all wavelengths [rad]: different ones would colour its edge.
double choose_forward_angle(const MieCommand& options,
                            const std::vector<bake::DropletOptics>& optics) {
    if (options.forward_angle != "auto") {
        const auto degrees = parse_number(options.forward_angle);
        if (!degrees || *degrees < 0 || *degrees > 90) {
            refuse_usage("--forward-angle",
                         "it is neither auto nor a number of degrees from 0 to 90",
                         "give 0 for no peak");
        }
        return *degrees * std::numbers::pi / 180;
    }
    std::vector<const bake::DropletOptics*> by_wavelength;
    by_wavelength.reserve(optics.size());
    for (const bake::DropletOptics& one : optics) {
        by_wavelength.push_back(&one);
    }
    std::sort(by_wavelength.begin(), by_wavelength.end(),
              [](const auto* a, const auto* b) { return a->wavelength < b->wavelength; });
    return bake::find_peak_angle(by_wavelength[by_wavelength.size() / 2]->phase);
}

Json describe_wavelength(const bake::DropletDistribution& droplets,
                         const bake::DropletOptics& optics, double forward_angle) {
    const double p_back = bake::eval_table(optics.phase, std::numbers::pi);
    const double kappa = bake::extinction(droplets, optics);
    const bake::PeakSplit split = bake::split_peak(optics.phase, forward_angle);
    return {{"wavelength_m", optics.wavelength},
            {"index", index_json(optics.index)},
            {"q_ext", optics.c_ext / optics.c_geo},
            {"q_sca", optics.c_sca / optics.c_geo},
            {"q_back", 4 * std::numbers::pi * p_back * optics.c_sca / optics.c_geo},
            {"q_abs", optics.c_abs / optics.c_geo},
            {"g", optics.g},
            {"cross_section_m2", optics.c_ext},
            {"extinction_per_m", kappa},
            {"albedo", 1 - bake::absorbed_share(optics)},
            {"absorbed_share", bake::absorbed_share(optics)},
            {"p_forward", optics.phase.value.front()},
            {"p_backward", p_back},
            {"forward_weight", split.weight},
            {"rest_g", bake::integrate_cosine(split.rest)},
            {"rest_extinction_per_m", bake::rest_extinction(split, kappa)},
            {"error", describe_error(optics)}};
}

Json describe_distribution(const MieCommand& options) {
    std::vector<double> wavelengths = options.droplets.substance.wavelengths;
    if (wavelengths.empty()) {
        wavelengths = {650 / 1e9, 550 / 1e9, 450 / 1e9};
    }
    const auto optics = average_droplets(options.droplets, wavelengths);
    const auto angle = choose_forward_angle(options, optics);
    const bake::DropletDistribution& droplets = options.droplets.droplets;
    Json all;
    all["droplets"] = describe_droplets(droplets);
    all["droplets"]["density_per_m3"] = droplets.density;
    all["droplets"]["geometric_section_m2"] = bake::mean_geometric_section(droplets);
    all["droplets"]["liquid_water_kg_per_m3"] = bake::liquid_water_content(droplets);
    all["forward_angle_deg"] = angle * 180 / std::numbers::pi;
    for (const bake::DropletOptics& one : optics) {
        all["wavelengths"].push_back(describe_wavelength(droplets, one, angle));
    }
    return all;
}

/// One line of values under one of names; of a list, its elements have numbers.
void print_lines(const std::vector<Json>& rows) {
    const auto print = [](const Json& row, bool names) {
        std::string line;
        const auto add = [&](const std::string& name, const Json& value) {
            line += (line.empty() ? "" : ",") + (names ? name : value.dump());
        };
        for (const auto& [key, value] : row.items()) {
            if (value.is_structured()) {
                for (const auto& [part, inner] : value.items()) {
                    add(fmt::format("{}_{}", key, part), inner);
                }
            } else {
                add(key, value);
            }
        }
        fmt::print("{}\n", line);
    };
    print(rows.front(), true);
    for (const Json& row : rows) {
        print(row, false);
    }
}

int run(const MieCommand& options) {
    check_options(options);
    const bool by_droplets = options.droplets.effective_radius_option.is_given();
    const Json all = by_droplets ? describe_distribution(options) : describe_sphere(options);
    if (options.format == TextFormat::json) {
        fmt::print("{}", json_text(all));
    } else if (by_droplets) {
        std::vector<Json> rows;
        for (const Json& wavelength : all["wavelengths"]) {
            rows.push_back(wavelength);
            rows.back()["forward_angle_deg"] = all["forward_angle_deg"];
        }
        print_lines(rows);
    } else {
        print_lines({all});
    }
    return kExitSuccess;
}

}  // namespace

void add_mie_command(Program& program) {
    auto [command, options] = add_command<MieCommand>(
        program, "mie", "Say how a sphere, or a cloud of droplets, scatters light", run);
    options.size_parameter_option = command.add(
        "--size-parameter", "X",
        real_number(options.size_parameter, bake::kMinSizeParameter, bake::kMaxSizeParameter),
        "of one sphere, 2 pi radius / wavelength");
    options.radius_option = command.add("--radius", "R", length(options.radius, 1e-15, 1),
                                        "of one sphere, micrometres or with a unit");
    add_droplet_options(command, options.droplets, false);
    options.density_option = command.add("--density", "N [3e8]",
                                         number_above(options.droplets.droplets.density, 0, 1e30),
                                         "droplets per cubic metre");
    options.forward_angle_option =
        command.add("--forward-angle", "auto|A [auto]", text(options.forward_angle),
                    "half angle of the forward peak in degrees, 0 to 90, counted as light that "
                    "goes straight on; auto: where the logarithm of the phase function of the "
                    "middle wavelength falls by less than 0.44 a degree");
    add_format_options(command, options.format, "csv: a line of names, and lines of values");
    command.footer(
        "Prints efficiencies (cross-sections over the geometric one) of extinction, scattering,\n"
        "absorption and backscattering (radar convention), and the mean cosine g of the angle.\n"
        "Of droplets, means over the distribution; extinction per metre; the share of scattered\n"
        "light inside the forward peak (forward_weight), and g and extinction of the rest. p is\n"
        "the phase function per steradian; it integrates to 1. error: of the mean over radii,\n"
        "half the difference between even and odd ones, relative (g: absolute).\n"
        "Lengths: plain numbers are micrometres; 550nm, 7um, 0.1mm and 1e-6m have their unit.\n"
        "Example:\n  opaline mie --size-parameter 10 --index 1.5\n"
        "  opaline mie --radius 0.525 --wavelength 632.8nm --index 1.55 --format csv\n"
        "  opaline mie --effective-radius 7um --gamma 2 --density 3e8");
}

}  // namespace opaline::cli
