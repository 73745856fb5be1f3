#include "bake/cli/droplet_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "bake/cli/machine_limits.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/progress.h"
#include "bake/physics/mie/mie_series.h"

namespace opaline::cli {
namespace {

constexpr double kLeastWavelength = 1e-8, kMostWavelength = 1e-1;      // [m]
constexpr double kLeastDropletRadius = 1e-10, kMostDropletRadius = 1;  // [m]

void add_substance_options(const Command& command, SubstanceOptions& options, bool one_channel) {
    options.wavelength_option =
        command.add("--wavelength", one_channel ? "W,... [550nm]" : "W,... [650nm,550nm,450nm]",
                    lengths(options.wavelengths, kLeastWavelength, kMostWavelength),
                    std::string("of the light in a vacuum, micrometres or with a unit; ") +
                        (one_channel ? "several with commas between make one channel of colour"
                                     : "several for droplets, with commas between"));
    if (one_channel) {
        options.weights_option =
            command.add("--weights", "A,... [equal]", real_numbers(options.weights, 0, 1e9),
                        "how much of each of several wavelengths the channel has, relative");
    }
    options.index_option = command.add("--index", "N[,K]", text(options.index),
                                       "index of refraction relative to the surroundings, real and "
                                       "imaginary part (0 or more, above 0 for absorption)");
    options.substance_option =
        command
            .add("--substance",
                 one_of(options.substance,
                        {{"water", bake::Substance::water}, {"ice", bake::Substance::ice}}),
                 "gives the index: water from 300 to 1000 nm, ice from 400 to 800 nm")
            .excludes(options.index_option);
}

}  // namespace

void add_droplet_options(const Command& command, DropletOptions& options, bool one_channel) {
    options.effective_radius_option = command.add(
        "--effective-radius", "R",
        length(options.droplets.effective_radius, kLeastDropletRadius, kMostDropletRadius),
        "of droplets, mean r^3 over mean r^2, micrometres or with a unit");
    options.gamma_option = command.add(
        "--gamma", "G [2]", real_number(options.droplets.gamma, bake::kMinGamma, bake::kMaxGamma),
        "shape of the distribution of radii, r^(gamma - 1) e^(-(gamma + 2) r / R): the larger, the "
        "narrower");
    add_substance_options(command, options.substance, one_channel);
    options.size_step_option =
        command.add("--size-step", "S [0.03]", real_number(options.sampling.size_step, 0.005, 10),
                    "step of the size parameter between the droplets that are computed; seconds "
                    "and accuracy grow as it falls");
    options.threads_option = add_threads_option(command, options.threads);
}

std::vector<std::string> given_droplet_options(const DropletOptions& options) {
    std::vector<std::string> names;
    for (const Option& option :
         {options.effective_radius_option, options.gamma_option, options.size_step_option,
          options.threads_option, options.substance.wavelength_option,
          options.substance.weights_option, options.substance.index_option,
          options.substance.substance_option}) {
        if (option.is_given()) names.push_back(option.name());
    }
    return names;
}

std::complex<double> parse_index(const std::string& text) {
    const std::size_t comma = text.find(',');
    const auto real = parse_number(text.substr(0, comma));
    const auto imaginary =
        comma == std::string::npos ? std::optional(0.0) : parse_number(text.substr(comma + 1));
    if (!real || !imaginary) {
        refuse_usage("--index", fmt::format("'{}' is not one number or two", shorten(text)),
                     "give N or N,K, for example 1.333 or 1.5,0.01");
    }
    const std::complex<double> index(*real, *imaginary);
    require(bake::check_sphere(1, index));
    return index;
}

std::complex<double> index_at(const SubstanceOptions& options, double wavelength) {
    return options.index.empty() ? require(bake::refractive_index(options.substance, wavelength))
                                 : parse_index(options.index);
}

std::vector<double> weights_of(const SubstanceOptions& options, std::size_t wavelengths) {
    if (options.weights.empty()) return std::vector<double>(wavelengths, 1.0);
    if (options.weights.size() != wavelengths) {
        refuse_usage(
            "--weights",
            fmt::format("there are {} for {} wavelengths", options.weights.size(), wavelengths),
            "give one for each wavelength of --wavelength");
    }
    if (std::ranges::none_of(options.weights, [](double weight) { return weight > 0; })) {
        refuse_usage("--weights", "all of them are 0", "give one above 0");
    }
    return options.weights;
}

std::vector<bake::DropletOptics> average_droplets(const DropletOptions& options,
                                                  const std::vector<double>& wavelengths) {
    require(check_threads(options.threads));
    std::vector<std::complex<double>> indices;
    for (const double wavelength : wavelengths) {
        indices.push_back(index_at(options.substance, wavelength));
    }
    if (bake::relative_width(options.droplets) < bake::kMonodisperse) {
        require(report_warnings({formats::make_warning(
            "", "--gamma",
            fmt::format(
                "radii spread by {:.2g} of their mean only, so that ripples of equal spheres show",
                bake::relative_width(options.droplets)),
            "give at most 396 for a cloud")}));
    }
    bake::Context context;
    context.threads = options.threads;
    context.cancel = &catch_interrupts();
    std::vector<bake::DropletOptics> all;
    for (std::size_t i = 0; i < wavelengths.size(); ++i) {
        all.push_back(require(bake::average_droplets(options.droplets, wavelengths[i], indices[i],
                                                     options.sampling, context)));
    }
    return all;
}

nlohmann::ordered_json describe_droplets(const bake::DropletDistribution& droplets) {
    return {{"effective_radius_m", droplets.effective_radius},
            {"gamma", droplets.gamma},
            {"characteristic_radius_m", bake::characteristic_radius(droplets)},
            {"relative_width", bake::relative_width(droplets)}};
}

nlohmann::ordered_json describe_error(const bake::DropletOptics& optics) {
    return {{"phase_rms", optics.error.phase_rms},
            {"phase_max", optics.error.phase_max},
            {"c_ext", optics.error.c_ext},
            {"c_sca", optics.error.c_sca},
            {"g", optics.error.g},
            {"radii", optics.radii}};
}

}  // namespace opaline::cli
