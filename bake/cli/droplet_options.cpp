#include "bake/cli/droplet_options.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <utility>

#include "bake/cli/interrupt.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/mie/mie_series.h"

namespace opaline::cli {
namespace {

constexpr double kLeastWavelength = 1e-8, kMostWavelength = 1e-1;      // [m]
constexpr double kLeastDropletRadius = 1e-10, kMostDropletRadius = 1;  // [m]

void add_substance_options(CLI::App& command, SubstanceOptions& options, bool one_channel) {
    options.wavelength_option =
        command
            .add_option("--wavelength", options.wavelengths,
                        std::string("of the light in a vacuum, micrometres or with a unit; ") +
                            (one_channel ? "several with commas between make one channel of colour"
                                         : "several for droplets, with commas between"))
            ->delimiter(',')
            ->allow_extra_args(false)
            ->transform(length(kLeastWavelength, kMostWavelength))
            ->option_text(one_channel ? "W,... [550nm]" : "W,... [650nm,550nm,450nm]");
    if (one_channel) {
        options.weights_option =
            command
                .add_option("--weights", options.weights,
                            "how much of each of several wavelengths the channel has, relative")
                ->delimiter(',')
                ->allow_extra_args(false)
                ->check(real_number(0, 1e9))
                ->option_text("A,... [equal]");
    }
    options.index_option =
        command
            .add_option("--index", options.index,
                        "index of refraction relative to the surroundings, real and imaginary part "
                        "(0 or more, above 0 for absorption)")
            ->option_text("N[,K]");
    options.substance_option =
        command
            .add_option("--substance", options.substance,
                        "gives the index: water from 300 to 1000 nm, ice from 400 to 800 nm")
            ->transform(one_of<bake::Substance>(
                {{"water", bake::Substance::water}, {"ice", bake::Substance::ice}}))
            ->option_text("water|ice [water]")
            ->excludes(options.index_option);
}

}  // namespace

void add_droplet_options(CLI::App& command, DropletOptions& options, bool one_channel) {
    options.effective_radius_option =
        command
            .add_option("--effective-radius", options.droplets.effective_radius,
                        "of droplets, mean r^3 over mean r^2, micrometres or with a unit")
            ->transform(length(kLeastDropletRadius, kMostDropletRadius))
            ->option_text("R");
    options.gamma_option =
        command
            .add_option("--gamma", options.droplets.gamma,
                        "shape of the distribution of radii, r^(gamma - 1) e^(-(gamma + 2) r / R): "
                        "the larger, the narrower")
            ->check(real_number(bake::kMinGamma, bake::kMaxGamma))
            ->option_text("G [2]");
    add_substance_options(command, options.substance, one_channel);
    options.size_step_option =
        command
            .add_option(
                "--size-step", options.sampling.size_step,
                "step of the size parameter between the droplets that are computed; seconds "
                "and accuracy grow as it falls")
            ->check(real_number(0.005, 10))
            ->option_text("S [0.03]");
    options.threads_option = add_threads_option(command, options.threads);
}

std::vector<std::string> given_droplet_options(const DropletOptions& options) {
    std::vector<std::string> names;
    for (const CLI::Option* option :
         {options.effective_radius_option, options.gamma_option, options.size_step_option,
          options.threads_option, options.substance.wavelength_option,
          options.substance.weights_option, options.substance.index_option,
          options.substance.substance_option}) {
        if (option != nullptr && option->count() > 0) {
            names.push_back(option->get_name());
        }
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
            fmt::format("radii spread by {:.2g} of their mean only, so that ripples of equal "
                        "spheres show",
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
