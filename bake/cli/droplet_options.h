#pragma once

#include <complex>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/cli/command.h"
#include "bake/physics/mie/droplet_optics.h"
#include "bake/physics/mie/droplets.h"
#include "bake/physics/mie/refractive_index.h"
#include "formats/opal/result.h"

namespace opaline::cli {

/// What a sphere or droplets are made of and which light meets them.
struct SubstanceOptions {
    std::vector<double> wavelengths;  ///< [m]; empty: the command's default
    std::vector<double> weights;      ///< of wavelengths that make one channel; empty: equal
    std::string index;                ///< "N" or "N,K"; empty: that of `substance`
    bake::Substance substance = bake::Substance::water;
    Option wavelength_option, weights_option, index_option, substance_option;
};

/// Droplets of modified-gamma sizes: options that `mie` and `phase --type mie` share.
struct DropletOptions {
    SubstanceOptions substance;
    bake::DropletDistribution droplets;
    bake::RadiusSampling sampling;
    unsigned threads = 0;
    Option effective_radius_option, gamma_option, size_step_option, threads_option;
};

/// `one_channel`: several wavelengths stand for one colour, with weights; otherwise for a list.
void add_droplet_options(const Command& command, DropletOptions& options, bool one_channel);

/// The options of a distribution that were given, by name; those of its substance too.
std::vector<std::string> given_droplet_options(const DropletOptions& options);

/// "N" or "N,K". Errors: usage.
std::complex<double> parse_index(const std::string& text);

/// The index that was given, or that of the substance at a wavelength [m]. Errors: usage.
std::complex<double> index_at(const SubstanceOptions& options, double wavelength);

/// Weights of as many wavelengths, which make one channel. Errors: usage.
std::vector<double> weights_of(const SubstanceOptions& options, std::size_t wavelengths);

/// Means over the droplets at each wavelength [m]. Warns of distributions so narrow that ripples of
/// equal spheres show. Errors: usage, resource, interrupted.
std::vector<bake::DropletOptics> average_droplets(const DropletOptions& options,
                                                  const std::vector<double>& wavelengths);

/// The droplets, and a wavelength's numerical error, as they are printed.
nlohmann::ordered_json describe_droplets(const bake::DropletDistribution& droplets);
nlohmann::ordered_json describe_error(const bake::DropletOptics& optics);

}  // namespace opaline::cli
