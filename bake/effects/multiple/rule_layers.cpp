#include "bake/effects/multiple/rule_layers.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "bake/effects/multiple/walks/walk_media.h"
#include "bake/plan/plan_input.h"
#include "bake/scattering/fresnel.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

// kappa / sigma_t of isotropic scattering: alpha / (2 k) ln((1 + k) / (1 - k)) = 1, by bisection.
double diffusion_exponent(double albedo) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double k = 0.5 * (low + high);
        (albedo * std::atanh(k) < k ? low : high) = k;
    }
    return low;
}

double reaches(const Band& band, double g, double eta, double depth) {
    const double straight = std::exp(-band.sigma_a * depth);
    const double reduced = (1 - g) * band.sigma_s, sigma_t = reduced + band.sigma_a;
    if (!(reduced > 0) || !(band.sigma_a > 0)) {
        return straight;
    }
    const double albedo = reduced / sigma_t, k = diffusion_exponent(albedo);
    const double far = k * sigma_t * depth;
    // x / sinh(x) without overflow; 1 at 0.
    const double decay = far > 0 ? 2 * far * std::exp(-far) / -std::expm1(-2 * far) : 1;
    const double stays = 1 - fresnel_moments(eta).diffuse_internal();
    return std::min(straight, (1 + k) / albedo * decay / std::max(stays, 1e-6));
}

}  // namespace

double share_that_reaches(const formats::Medium& medium, double depth) {
    double most = 0;
    for (const Band& band : bands_of(medium)) {
        most = std::max(most, reaches(band, formats::mean_cosine(medium.phase),
                                      static_cast<double>(medium.eta), depth));
    }
    return most;
}

double layer_bound(const formats::Medium& medium, const MaterialFacts& body) {
    double nearest = HUGE_VAL;
    for (const InnerMedium& inner : body.inner) {
        if (!is_same_medium(medium, inner.medium)) {
            nearest = std::min(nearest, inner.depth);
        }
    }
    return std::isfinite(nearest) ? share_that_reaches(medium, nearest) : 0;
}

bool has_inner_media(const PlanInput& input) {
    return input.material.medium && !input.subject.inner.empty();
}

PlanEntry decide_layers(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    PlanEntry entry;
    entry.alternative = entry.layered = true;
    entry.bound = layer_bound(medium, input.subject);
    if (!earlier_entry(input, "multiple")->on) {
        entry.reason = "no light that scatters inside is simulated";
    } else if (std::ranges::all_of(input.subject.inner, [&](const InnerMedium& inner) {
                   return is_same_medium(medium, inner.medium);
               })) {
        entry.reason = "the media inside are the same as its own";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = "the media inside lie so deep that hardly any light reaches them";
    } else {
        entry.reason = "light goes through other media inside";
    }
    return entry;
}

const PlanEntry* earlier_entry(const PlanInput& input, std::string_view name) {
    const auto found = std::ranges::find_if(
        input.earlier, [name](const PlanEntry& entry) { return entry.name == name; });
    return found == input.earlier.end() ? nullptr : &*found;
}

std::vector<std::uint32_t> inner_materials(const EffectInputs& inputs) {
    std::vector<std::uint32_t> materials;
    for (const InnerMedium& inner : inputs.bake.facts.material[inputs.material].inner) {
        materials.push_back(inner.material);
    }
    return materials;
}

void warn_of_layers(const EffectInputs& inputs, std::vector<formats::Diagnostic>& warnings) {
    const formats::Scene& scene = inputs.bake.scene;
    std::string names;
    for (const InnerMedium& inner : inputs.bake.facts.material[inputs.material].inner) {
        names += (names.empty() ? "'" : ", '") + scene.materials[inner.material].name + "'";
    }
    warnings.push_back(formats::make_warning(
        "", "material '" + scene.materials[inputs.material].name + "'",
        "other media lie inside (" + names + "), but the model takes the body for one medium alone",
        "bake with --multiple-model auto or walks, which pass through them"));
}

}  // namespace opaline::bake
