#include "bake/plan/knobs.h"

#include <algorithm>
#include <array>

#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::make_error;

Knobs preset(Quality quality) {
    Knobs knobs;
    knobs.quality = quality;
    switch (quality) {
        case Quality::draft:
            // As few coefficients resolve no more texels: they err less of 8 than of 16.
            knobs.cubemap_size = 8;
            knobs.coefficients = 64;
            knobs.samples = 20000;
            knobs.tolerance = 1e-2;
            knobs.depth_samples = 4;
            knobs.phase_tolerance = 0.05;
            knobs.single_cubemap = 8;
            return knobs;
        case Quality::preview:
            return knobs;
        case Quality::production:
            // Twice the cube map would cost four times the rays; what errs is truncation.
            knobs.cubemap_size = 32;
            knobs.coefficients = 1024;
            knobs.samples = 150000;
            knobs.samples_per_path = 4;
            knobs.phase_tolerance = 0.01;
            return knobs;
        default:
            knobs.cubemap_size = 64;
            knobs.coefficients = kAllCoefficients;
            knobs.code_bits = 16;
            knobs.samples = 300000;
            knobs.samples_per_path = 8;
            knobs.tolerance = 1e-5;
            knobs.depth_samples = 16;
            knobs.phase_tolerance = 1e-3;
            knobs.single_cubemap = 64;
            knobs.exact_rays = true;
            return knobs;
    }
}

}  // namespace

std::string_view quality_name(Quality quality) {
    constexpr std::array<std::string_view, 4> names{"draft", "preview", "production", "reference"};
    return names[static_cast<std::size_t>(quality)];
}

std::uint32_t expected_coefficients(double target) {
    return static_cast<std::uint32_t>(std::clamp(4 / target, 64.0, 1024.0));
}

std::uint32_t sample_coefficients(const Knobs& knobs) {
    return std::clamp(knobs.coefficients / 2, std::min(knobs.coefficients, 512u), 4096u);
}

formats::Result<Knobs> resolve_knobs(const BakeOptions& options) {
    Knobs knobs = preset(options.quality);
    knobs.effects = options.effects;
    knobs.simulate_all = options.simulate_all;
    knobs.check_model = options.check_model;
    knobs.seed = options.seed;
    knobs.separate_terms = options.separate_terms;
    if (options.error != 0) {
        if (!(options.error >= 1e-4 && options.error < 1)) {
            return make_error(ErrorKind::usage, "", "--error", "the error must be in [0.0001, 1)",
                              "give a relative RMS, such as 0.02 for 2 %");
        }
        knobs.error_target = options.error;
        knobs.cubemap_size = options.error < 0.03 ? 16 : 8;
        knobs.coefficients = expected_coefficients(options.error);
        knobs.phase_tolerance = 0.5 * options.error;
        if (options.error < 0.03) {
            // One sample for each path errs by .7 to 1.5 %: a pilot of it would be for nothing.
            knobs.samples_per_path = 4;
            knobs.samples *= 4;
        }
        knobs.fixed = {options.cubemap_size != 0, options.coefficients != 0, options.tolerance >= 0,
                       options.depth_samples != 0};
    }
    if (options.samples != 0) {
        knobs.samples = options.samples;
        knobs.exact_samples = true;
    }
    if (options.tolerance >= 0) {
        knobs.tolerance = options.tolerance;
    }
    if (options.depth_samples != 0) {
        knobs.depth_samples = options.depth_samples;
    }
    if (options.phase_terms != 0) {
        constexpr std::array<std::uint32_t, 5> kWhole{1, 4, 9, 16, 25};
        bool is_whole = false;
        for (const std::uint32_t k : kWhole) {
            is_whole = is_whole || k == options.phase_terms;
        }
        if (!is_whole) {
            return make_error(ErrorKind::usage, "", "--phase-terms",
                              std::to_string(options.phase_terms) +
                                  " terms cut a degree of the phase function in two",
                              "give 1, 4, 9, 16 or 25");
        }
        knobs.phase_terms = options.phase_terms;
    }
    if (options.cubemap_size != 0) {
        if (!formats::is_valid_cubemap_size(options.cubemap_size)) {
            return make_error(ErrorKind::usage, "", "--cubemap",
                              std::to_string(options.cubemap_size) + " is not a cube map size",
                              "give 8, 16, 32, 64 or 128");
        }
        knobs.cubemap_size = options.cubemap_size;
    }
    if (options.coefficients != 0) {
        if (options.coefficients < 7) {
            return make_error(ErrorKind::usage, "", "--coefficients",
                              "the six face averages and one detail are the least",
                              "give 7 or more, or `all`");
        }
        knobs.coefficients = options.coefficients;
    }
    knobs.single_cubemap = std::min(knobs.single_cubemap, knobs.cubemap_size);
    if (knobs.coefficients >= formats::cubemap_texels(knobs.cubemap_size)) {
        knobs.coefficients = kAllCoefficients;
    }
    return knobs;
}

}  // namespace opaline::bake
