#include "bake/effects/direct/direct.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "bake/plan/add_other_light.h"
#include "bake/plan/walk_work.h"
#include "bake/scattering/half_space_medium.h"
#include "bake/transport/irradiance_transport.h"
#include "bake/truth/true_reflection.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

// A medium is shown as a diffuse surface, for comparison, where this effect is named and none that
// acts inside media is.
PlanEntry decide(const PlanInput& input) {
    PlanEntry entry;
    // Under `white` a diffuse surface reflects at most its albedo.
    const formats::Rgb c = input.material.base_color;
    entry.bound = static_cast<double>(std::max({c.r, c.g, c.b}) * input.subject.brightest_vertex *
                                      formats::diffuse_share(input.material));
    entry.alternative = input.material.medium.has_value();
    if (entry.alternative && (!is_named(input.knobs, "direct") || input.knobs.looks_inside_media)) {
        entry.bound = 0;
        entry.reason = "light enters the medium instead of being reflected diffusely";
    } else if (!is_wanted(input.knobs, "direct")) {
        entry.reason = "left out by --effects";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = formats::diffuse_share(input.material) > 0
                           ? "the base colour is black, or nearly: nothing is reflected"
                           : "a metal reflects nothing diffusely";
    } else {
        entry.reason = entry.alternative
                           ? "the medium is shown as a diffuse surface of the same reflectance"
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
    {{"direct", [](const PlanInput& input) { return !is_thin_walled(input); }, decide, lay_out}}};

// The reflectance of the medium that is shown as a surface.
struct Albedo : Prepared {
    formats::Rgb value;
};

PreparedPtr study(const EffectInputs& inputs, std::uint64_t&) {
    auto albedo = std::make_unique<Albedo>();
    albedo->value = half_space_albedo(inputs.medium(), inputs.knobs.seed, inputs.context);
    return albedo;
}

struct Directions : Prepared {
    DirectionSet set;
};

PreparedPtr prepare(const EffectInputs& inputs, std::uint64_t&) {
    auto directions = std::make_unique<Directions>();
    if (inputs.bake.has_environment()) {
        directions->set = make_direction_set(inputs.knobs.cubemap_size);
    }
    return directions;
}

// T = V max(0, n.w) / pi: albedo 1.
std::uint64_t add_environment(const EffectInputs& inputs, const Receiver& receiver,
                              const DenseRow& row) {
    const auto& directions = static_cast<const Directions&>(*inputs.own.prepared).set;
    std::vector<float> dense(row.size());
    const std::uint64_t rays = gather_irradiance(inputs.outside(), directions, receiver, dense);
    for (float& value : dense) {
        value *= std::numbers::inv_pi_v<float>;
    }
    formats::haar_forward_cube(std::span<float>(dense), row.cubemap_size);
    for (std::uint32_t band = 0; band < row.bands; ++band) {
        const std::span<float> to = row.plane(0, band);
        for (std::size_t k = 0; k < dense.size(); ++k) {
            to[k] += dense[k];
        }
    }
    return rays;
}

std::uint64_t add(const EffectInputs& inputs, const GatherReceiver& receiver, const DenseRow& row) {
    constexpr float kShare = std::numbers::inv_pi_v<float>;
    std::uint64_t rays = 0;
    if (inputs.bake.has_environment()) {
        rays += add_environment(inputs, receiver.outside, row);
    }
    return rays +
           add_other_light(inputs.light(), receiver.outside, {{0, {kShare, kShare, kShare}}}, row);
}

struct Truth : Prepared {
    ReflectionTruth truth;
    OtherLight::TrueIrradiance other;
};

PreparedPtr make_truth(const EffectInputs& inputs, TruthEffort, std::span<const TestLight> lights) {
    auto truth = std::make_unique<Truth>();
    truth->truth = make_reflection_truth(lights);
    truth->other = inputs.true_light(lights);
    return truth;
}

TwoEstimates eval(const EffectInputs& inputs, const Prepared& prepared,
                  const TruthReceiver& receiver, std::uint64_t& rays) {
    const auto& own = static_cast<const Truth&>(prepared);
    TwoEstimates seen = eval_reflection(own.truth, inputs.bake.rays, receiver.outside, rays);
    rays += add_true_other_light(own.other, receiver.outside, receiver.key, 1, seen);
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
                  .work = [](const SubjectCost& c) { return walk_work(c.medium()); }},
        .prepare = {.run = prepare},
        .gather = {.add = add,
                   .work =
                       [](const SubjectCost& c) {
                           return irradiance_work(c.input, c.receivers, c.layout.occluded);
                       }},
        .truth = {.reference = "rays to the suns, and to all else four a texel of 6 x 64 x 64",
                  .make = make_truth,
                  .eval = eval,
                  .work = [](const SubjectCost& c,
                             TruthEffort) { return true_irradiance_work(c); }},
        .adds_other_light = true,
        .tint = [](const Prepared& albedo) { return static_cast<const Albedo&>(albedo).value; }};
}

}  // namespace opaline::bake
