#include "bake/effects/direct/direct.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "bake/exchange/other_light.h"
#include "bake/lights/true_irradiance.h"
#include "bake/physics/slab/even_light.h"
#include "bake/plan/stage_work.h"
#include "bake/receivers/other_side.h"
#include "bake/scene/coverage.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

// A medium is shown as a diffuse surface, for comparison, where this effect is named and none that
// acts inside media is.
PlanEntry decide(const PlanInput& input) {
    PlanEntry entry;
    // Under `white` a diffuse surface reflects at most its albedo; a metal mirrors at most that of
    // what others send, from the part of the sky that they stand before.
    const formats::Rgb c = input.material.base_color;
    const bool is_metal = formats::is_metal(input.material);
    // What rises above the horizon of a wall's back is not known.
    const double elevation = input.material.sheet ? 1 : input.subject.horizon.elevation;
    entry.bound = static_cast<double>(std::max({c.r, c.g, c.b}) * input.subject.brightest_vertex);
    entry.bound *=
        !is_metal ? static_cast<double>(formats::diffuse_share(input.material))
                  : std::min(1.0, elevation * elevation) * input.subject.surroundings.brightest;
    entry.alternative = input.material.medium.has_value();
    if (entry.alternative && (!is_named(input.knobs, "direct") || input.knobs.looks_inside_media)) {
        entry.bound = 0;
        entry.reason = "light enters the medium instead of being reflected diffusely";
    } else if (!is_wanted(input.knobs, "direct")) {
        entry.reason = "left out by --effects";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = is_metal ? "a metal reflects nothing diffusely"
                                : "the base colour is black, or nearly: nothing is reflected";
    } else {
        entry.reason = entry.alternative
                           ? "the medium is shown as a diffuse surface of the same reflectance"
                       : is_metal ? "the metal mirrors what other surfaces send to it"
                                  : "the surface reflects diffusely";
    }
    entry.as_surface = entry.on && entry.alternative;
    return entry;
}

void lay_out(const PlanEntry& entry, RowLayout& layout) {
    if (entry.on) {
        layout.constant = true;
        layout.translucent = false;
    }
}

constexpr std::array<DecisionRule, 1> kRules{
    {{"direct",
      [](const PlanInput& input) { return !is_thin_walled(input) || is_wall(input.material); },
      decide, lay_out}}};

// The reflectance of the medium that is shown as a surface.
struct Albedo : Prepared {
    formats::Rgb value;
};

PreparedPtr study(const EffectInputs& inputs, std::uint64_t&) {
    auto albedo = std::make_unique<Albedo>();
    albedo->value = half_space_albedo(inputs.medium());
    return albedo;
}

struct Directions : Prepared {
    DirectionSet set;
};

PreparedPtr prepare(const EffectInputs& inputs, std::uint64_t&) {
    auto directions = std::make_unique<Directions>();
    if (has_environment(inputs.bake.light)) {
        directions->set = make_direction_set(inputs.knobs.cubemap_size);
    }
    return directions;
}

bool is_of_metal(const EffectInputs& inputs) {
    return formats::is_metal(inputs.bake.scene.materials[inputs.material]);
}

// T = V max(0, n.w) / pi: albedo 1. `term`: 0, or 1 of the other side of a wall.
std::uint64_t add_environment(const EffectInputs& inputs, const Receiver& receiver,
                              std::uint32_t term, const DenseRow& row) {
    const auto& directions = static_cast<const Directions&>(*inputs.own.prepared).set;
    std::vector<float> dense(row.size());
    const std::uint64_t rays = gather_irradiance(inputs.outside(), directions, receiver, dense);
    for (float& value : dense) {
        value *= std::numbers::inv_pi_v<float>;
    }
    formats::haar_forward_cube(std::span<float>(dense), row.cubemap_size);
    for (std::uint32_t band = 0; band < row.bands; ++band) {
        const std::span<float> to = row.plane(term, band);
        for (std::size_t k = 0; k < dense.size(); ++k) {
            to[k] += dense[k];
        }
    }
    return rays;
}

std::uint64_t add_side(const EffectInputs& inputs, const Receiver& receiver, std::uint32_t term,
                       const DenseRow& row) {
    constexpr float kShare = std::numbers::inv_pi_v<float>;
    std::uint64_t rays = 0;
    if (has_environment(inputs.bake.light) && !is_of_metal(inputs)) {
        rays += add_environment(inputs, receiver, term, row);
    }
    return rays +
           add_other_light(light_of(inputs), receiver, {{term, {kShare, kShare, kShare}}}, row);
}

bool has_two_sides(const EffectInputs& inputs) {
    return inputs.bake.scene.materials[inputs.material].sheet.has_value();
}

std::uint64_t add(const EffectInputs& inputs, const GatherReceiver& receiver, const DenseRow& row) {
    std::uint64_t rays = add_side(inputs, receiver.outside, 0, row);
    if (has_two_sides(inputs)) {
        rays += add_side(inputs, other_side(receiver.outside, receiver.inside), 1, row);
    }
    return rays;
}

struct Truth : Prepared {
    ReflectionTruth truth;
    std::optional<BounceTruth> other;
};

PreparedPtr make_truth(const EffectInputs& inputs, TruthEffort, std::span<const TestLight> lights) {
    auto truth = std::make_unique<Truth>();
    truth->truth = make_reflection_truth(lights, inputs.bake.between);
    truth->other = true_light_of(inputs, lights);
    return truth;
}

TwoEstimates eval(const EffectInputs& inputs, const Prepared& prepared,
                  const TruthReceiver& receiver, std::uint64_t& rays) {
    const auto& own = static_cast<const Truth&>(prepared);
    const bool is_behind = has_two_sides(inputs) && receiver.behind;
    const Receiver at =
        is_behind ? other_side(receiver.outside, receiver.inside) : receiver.outside;
    TwoEstimates seen = eval_reflection(own.truth, inputs.bake.rays, at, rays);
    if (is_of_metal(inputs)) {
        std::ranges::fill(seen.first, 0.0);
        std::ranges::fill(seen.second, 0.0);
    }
    rays += add_true_other_light(own.other, at, receiver.key, 1, seen);
    return seen;
}

}  // namespace

EffectDescriptor describe_direct(Effect id) {
    return {
        .id = id,
        .name = "direct",
        .help = "light reflected by opaque surfaces",
        .rules = kRules,
        .study = {.stage = "albedos of media",
                  .applies = [](const formats::Material& material,
                                const RowLayout&) { return material.medium.has_value(); },
                  .run = study,
                  .work = [](const SubjectCost&) { return even_light_work(); }},
        .prepare = {.run = prepare},
        .gather = {.add = add,
                   .work =
                       [](const SubjectCost& c) {
                           const double sides = c.layout.sheet ? 2 : 1;
                           return irradiance_work(c.input, sides * c.receivers, c.layout.occluded);
                       }},
        .truth = {.reference = "rays to the suns, and to all else one a texel of 6 x 64 x 64",
                  .make = make_truth,
                  .eval = eval,
                  .work = [](const SubjectCost& c,
                             TruthEffort) { return true_irradiance_work(c); }},
        .adds_other_light = true,
        .tint = [](const Prepared& albedo) { return static_cast<const Albedo&>(albedo).value; }};
}

}  // namespace opaline::bake
