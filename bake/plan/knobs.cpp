#include "bake/plan/knobs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/plan/effect.h"
#include "bake/plan/plan_input.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::make_error;

// The knobs that belong to no effect. At M = 64, N = 8 has a lower error than N = 16.
Knobs preset(const EffectTable& effects, Quality quality) {
    constexpr std::array<std::uint32_t, 4> kCubemap{8, 16, 32, 64};
    constexpr std::array<std::uint32_t, 4> kCoefficients{64, 128, 1024, kAllCoefficients};
    const auto q = static_cast<std::size_t>(quality);
    Knobs knobs;
    knobs.quality = quality;
    knobs.cubemap_size = kCubemap[q];
    knobs.coefficients = kCoefficients[q];
    knobs.code_bits = quality == Quality::reference ? 16 : 8;
    knobs.exact_rays = quality == Quality::reference;
    for (const EffectDescriptor& effect : effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            knobs.set(*knob, knob->preset[q]);
        }
    }
    return knobs;
}

// Where the pilot begins, but for what the user gave.
void start_from(double error, const EffectTable& effects, Knobs& knobs) {
    if (!knobs.cubemap_given) {
        knobs.cubemap_size = error < 0.03 ? 16 : 8;
    }
    if (!knobs.coefficients_given) {
        knobs.coefficients = expected_coefficients(error);
    }
    for (const EffectDescriptor& effect : effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            if (knob->for_target != nullptr && !knobs.is_given(*knob)) {
                knobs.set(*knob, knob->for_target(error));
            }
        }
    }
}

formats::Status start_from_target(Knobs& knobs, const EffectTable& effects,
                                  const BakeOptions& options) {
    if (!(options.error >= 1e-4 && options.error < 1)) {
        return make_error(ErrorKind::usage, "", "--error", "the error must be in [0.0001, 1)",
                          "give a relative RMS, such as 0.02 for 2 %");
    }
    knobs.error_target = options.error;
    start_from(options.error, effects, knobs);
    return formats::ok_status();
}

formats::Status take_given(Knobs& knobs, const KnobValues& given) {
    for (const auto& [knob, value] : given.values) {
        if (knob->zero_is_auto && value == 0) continue;
        const auto& allowed = knob->allowed;
        if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), value) == allowed.end()) {
            std::string list;
            for (const double one : allowed) {
                list += (list.empty() ? "" : ", ") + std::to_string(static_cast<int>(one));
            }
            return make_error(ErrorKind::usage, "", std::string(knob->option),
                              std::to_string(static_cast<long>(value)) + " is not a valid value",
                              "give one of " + list);
        }
        if (!(value >= knob->lowest && value <= knob->highest)) {
            return make_error(ErrorKind::usage, "", std::string(knob->option),
                              "the value is out of range", "`opaline bake --help` states it");
        }
        knobs.set(*knob, value);
        knobs.given.push_back(knob);
    }
    return formats::ok_status();
}

}  // namespace

const double* KnobValues::find(const KnobSpec& knob) const {
    const auto found =
        std::find_if(values.begin(), values.end(), [&](const Value& v) { return v.knob == &knob; });
    return found == values.end() ? nullptr : &found->value;
}

void KnobValues::set(const KnobSpec& knob, double value) {
    const auto found =
        std::find_if(values.begin(), values.end(), [&](const Value& v) { return v.knob == &knob; });
    if (found == values.end()) {
        values.push_back({&knob, value});
    } else {
        found->value = value;
    }
}

double Knobs::operator[](const KnobSpec& knob) const {
    const double* const value = values.find(knob);
    return value != nullptr ? *value : knob.preset[static_cast<std::size_t>(quality)];
}

void Knobs::set(const KnobSpec& knob, double value) {
    values.set(knob, value);
}

double Knobs::numerical_target() const {
    const double reachable = std::max(error_target, model_error);
    const double left = reachable * reachable - model_error * model_error;
    return std::max(0.5 * reachable, std::sqrt(left));
}

Knobs with_model_error(const EffectTable& effects, Knobs knobs, double error) {
    knobs.model_error = error;
    if (knobs.error_target > 0 && error > knobs.error_target) {
        start_from(std::min(error, 1.0), effects, knobs);
    }
    return settle(std::move(knobs));
}

bool Knobs::is_given(const KnobSpec& knob) const {
    return std::find(given.begin(), given.end(), &knob) != given.end();
}

std::uint32_t whole(const Knobs& knobs, const KnobSpec& knob) {
    return static_cast<std::uint32_t>(knobs[knob]);
}

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

Knobs settle(Knobs knobs) {
    for (auto& [knob, value] : knobs.values.values) {
        if (knob->at_most_cubemap) {
            value = std::min(value, static_cast<double>(knobs.cubemap_size));
        }
    }
    if (knobs.coefficients >= formats::cubemap_texels(knobs.cubemap_size)) {
        knobs.coefficients = kAllCoefficients;
    }
    return knobs;
}

formats::Result<Knobs> resolve_knobs(const EffectTable& effects, const BakeOptions& options) {
    Knobs knobs = preset(effects, options.quality);
    knobs.effects = options.effects;
    knobs.looks_inside_media = std::any_of(
        effects.effects.begin(), effects.effects.end(),
        [&](const auto& effect) { return effect.inside_media && is_wanted(knobs, effect.name); });
    knobs.simulate_all = options.simulate_all;
    knobs.check_model = options.check_model;
    knobs.refine = options.refine;
    knobs.seed = options.seed;
    knobs.separate_terms = options.separate_terms;
    knobs.simplify = options.simplify;
    if (options.refine.mode == RefineChoice::Mode::off && options.refine.max_receivers > 0) {
        return make_error(ErrorKind::usage, "", "--max-receivers",
                          "with --refine off no receivers are added", "leave out one of them");
    }
    if (options.error != 0) {
        if (auto status = start_from_target(knobs, effects, options); !status) {
            return std::move(status).error();
        }
    }
    if (auto status = take_given(knobs, options.given); !status) return std::move(status).error();
    if (options.cubemap_size != 0) {
        if (!formats::is_valid_cubemap_size(options.cubemap_size)) {
            return make_error(ErrorKind::usage, "", "--cubemap",
                              std::to_string(options.cubemap_size) + " is not a cube map size",
                              "give 8, 16, 32, 64 or 128");
        }
        knobs.cubemap_size = options.cubemap_size;
        knobs.cubemap_given = true;
    }
    if (options.coefficients != 0) {
        if (options.coefficients < 7) {
            return make_error(ErrorKind::usage, "", "--coefficients",
                              "a row keeps at least the six face averages and one detail",
                              "give 7 or more, or `all`");
        }
        knobs.coefficients = options.coefficients;
        knobs.coefficients_given = true;
    }
    return settle(std::move(knobs));
}

}  // namespace opaline::bake
