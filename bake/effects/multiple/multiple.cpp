#include "bake/effects/multiple/multiple.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "bake/effects/multiple/choose_model.h"
#include "bake/effects/multiple/gather_multiple.h"
#include "bake/effects/multiple/multiple_costs.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/effects/multiple/rule_multiple.h"
#include "bake/effects/multiple/thin_parts.h"
#include "bake/effects/multiple/true_multiple.h"
#include "bake/effects/multiple/view_terms.h"
#include "bake/effects/multiple/walks/true_walks.h"
#include "bake/exchange/other_light.h"
#include "bake/lights/true_irradiance.h"
#include "bake/physics/fresnel.h"
#include "bake/scene/medium_field.h"

namespace opaline::bake {
namespace {

void lay_out(const PlanEntry& entry, RowLayout& layout) {
    layout.constant = layout.constant || entry.on;
}

void lay_out_layers(const PlanEntry& entry, RowLayout& layout) {
    layout.layered = entry.on;
}

// Another model fills the same rows.
void lay_out_model(const PlanEntry&, RowLayout&) {}

void lay_out_views(const PlanEntry& entry, RowLayout& layout) {
    layout.view_harmonics = entry.on ? entry.terms : 0;
}

constexpr std::array<const KnobSpec*, 8> kKnobs{&kMultipleModel,  &kViewTerms,   &kSamples,
                                                &kSamplesPerPath, &kWalksAround, &kWalks,
                                                &kSites,          &kEpsilon};

// A pilot tries the tolerance; samples are refined round by round.
constexpr std::array<PilotLadder::Setting, 1> kFinest{{{&kEpsilon, 3e-5}}};
constexpr std::array<std::array<PilotLadder::Setting, 1>, 5> kSettings{{{{{&kEpsilon, 1e-2}}},
                                                                        {{{&kEpsilon, 3e-3}}},
                                                                        {{{&kEpsilon, 1e-3}}},
                                                                        {{{&kEpsilon, 3e-4}}},
                                                                        {{{&kEpsilon, 1e-4}}}}};
constexpr std::array<std::span<const PilotLadder::Setting>, 5> kLevels{
    kSettings[0], kSettings[1], kSettings[2], kSettings[3], kSettings[4]};
constexpr std::array<PilotLadder, 1> kPilot{{{&kEpsilon, kLevels, kFinest, 0.1}}};

// False: they are as fine as they get, or the user's.
bool refine_samples(Knobs& knobs) {
    constexpr double kMostPerPath = 64, kMostSamples = 1000000;
    if (knobs.is_given(kSamples) || knobs[kSamplesPerPath] >= kMostPerPath ||
        2 * knobs[kSamples] > kMostSamples) {
        return false;
    }
    knobs.set(kSamplesPerPath, 4 * knobs[kSamplesPerPath]);
    knobs.set(kSamples, std::min(4 * knobs[kSamples], kMostSamples));
    // No more walks than `reference` takes: they cost most.
    const auto add_walks = [&](const KnobSpec& knob) {
        knobs.set(knob, std::max(knobs[knob], std::min(4 * knobs[knob], knob.preset.back())));
    };
    add_walks(kWalksAround);
    add_walks(kWalks);
    return true;
}

struct Studied : Prepared {
    MediumProfile profile;
    ModelChoice choice;
};
struct Samples : Prepared {
    MultipleStage stage;
};

const MediumProfile& profile_of(const EffectState& state) {
    return static_cast<const Studied&>(*state.study).profile;
}

const ModelChoice& choice_of(const Prepared& study) {
    return static_cast<const Studied&>(study).choice;
}

MultipleModel model_of(const EffectState& state) {
    return choice_of(*state.study).model;
}

PreparedPtr study(const EffectInputs& inputs, std::uint64_t& rays) {
    auto studied = std::make_unique<Studied>();
    studied->profile = make_medium_profile(even_medium(inputs.bake.scene, inputs.material));
    studied->choice = choose_model(inputs, studied->profile, rays);
    if (studied->choice.model == MultipleModel::walks && studied->choice.all_orders &&
        measures_views(inputs.knobs)) {
        studied->choice.views = measure_views(inputs, studied->profile, rays);
    }
    return studied;
}

bool needs_samples(const formats::Material&, const RowLayout& layout) {
    return !layout.at_entry;
}

// Places of the material's receivers: none else reads its samples.
std::vector<BodyPoint> served_by(const EffectInputs& inputs) {
    std::vector<BodyPoint> served;
    for (const ReceiverSet& set : inputs.bake.receivers) {
        if (set.material == inputs.material) {
            served.insert(served.end(), set.inside.begin(), set.inside.end());
        }
    }
    return served;
}

// Rows of single points are as fine as those of the file.
double count_served(const EffectInputs& inputs, std::size_t served) {
    return std::max(inputs.bake.facts.material[inputs.material].receivers,
                    static_cast<double>(served));
}

PreparedPtr take_samples(const EffectInputs& inputs, std::uint64_t& rays) {
    const Knobs& knobs = inputs.knobs;
    const bool walks_alone = !has_environment(inputs.bake.light) &&
                             takes_walks_alone(inputs.medium(), inputs.layout, knobs);
    const std::vector<BodyPoint> served = served_by(inputs);
    auto samples = std::make_unique<Samples>();
    samples->stage = prepare_multiple(inputs.bake.scene, inputs.outside(), inputs.bake.rays,
                                      inputs.material, profile_of(inputs.own),
                                      {knobs.cubemap_size,
                                       whole(knobs, kSamples),
                                       knobs.is_given(kSamples),
                                       knobs[kSamplesPerPath],
                                       served,
                                       count_served(inputs, served.size()),
                                       sample_coefficients(knobs),
                                       knobs.seed,
                                       !knobs.exact_rays,
                                       inputs.layout.bands(),
                                       walks_alone ? MultipleModel::walks : model_of(inputs.own),
                                       {knobs[kWalksAround], knobs[kWalks], whole(knobs, kSites)},
                                       knobs[kEpsilon],
                                       std::max(1u, inputs.layout.view_harmonics),
                                       inputs.layout.all_orders || walks_alone,
                                       inputs.layout.fills_crossed,
                                       inner_materials(inputs),
                                       inputs.layout.layered,
                                       light_of(inputs),
                                       meets_others(inputs),
                                       inputs.layout.layered && inputs.layout.crosses},
                                      inputs.context);
    rays += samples->stage.rays;
    return samples;
}

std::uint64_t add(const EffectInputs& inputs, const GatherReceiver& receiver, const DenseRow& row) {
    add_multiple_rows(static_cast<const Samples&>(*inputs.own.samples).stage, receiver.inside,
                      inputs.knobs[kEpsilon], inputs.layout, row);
    return 0;
}

// R Ft(c) / (pi c_exit): T_d = R E where light leaves where it entered.
void add_at_entry(const EffectInputs& inputs, std::span<std::vector<double>> factor) {
    const MediumProfile& profile = profile_of(inputs.own);
    const auto eta = static_cast<double>(inputs.medium().eta);
    for (std::size_t band = 0; band < factor.size(); ++band) {
        for (std::uint32_t i = 0; i <= kCosineSteps; ++i) {
            const double cosine = static_cast<double>(i) / kCosineSteps;
            factor[band][i] += profile.total(band) * fresnel_transmittance(cosine, eta) /
                               (std::numbers::pi * profile.exit);
        }
    }
}

struct Truth : Prepared {
    SurfaceIntegral integral;  // of the dipole
    WalkSpace space;           // of walks
    ExitLobe lobe;
    SunRays suns;
    SmoothLights smooth;
    std::optional<BounceTruth> other;
    std::uint32_t points = 0;
};

// Points of the surface for each of two estimates. The truth need not be finer than the target.
std::uint32_t truth_points(TruthEffort effort) {
    return effort.target >= 0.03 ? 256 : effort.target >= 0.015 ? 512 : 1024;
}

PreparedPtr make_truth(const EffectInputs& inputs, TruthEffort effort,
                       std::span<const TestLight> lights) {
    constexpr std::uint32_t kRaysPerSun = 4;  // at a random point of many
    auto truth = std::make_unique<Truth>();
    if (model_of(inputs.own) == MultipleModel::dipole) {
        truth->integral =
            make_surface_integral(inputs.bake.scene, inputs.material, profile_of(inputs.own));
    } else {
        truth->space = make_walk_space(inputs.bake.scene, inputs.bake.rays.hierarchy(),
                                       inputs.material, inputs.layout.bands() == 1,
                                       inner_materials(inputs), meets_others(inputs));
        truth->lobe = make_exit_lobe(profile_of(inputs.own).eta);
    }
    truth->suns = make_sun_rays(lights, kRaysPerSun, inputs.bake.between);
    truth->smooth = make_smooth_lights(lights, inputs.bake.between);
    truth->other = true_light_of(inputs, lights);
    truth->points = truth_points(effort);
    return truth;
}

// Rows by view are asked for one view; else the mean over all is what the row holds.
glm::vec3 seen_of(const EffectInputs& inputs, const TruthReceiver& receiver) {
    if (receiver.seen != glm::vec3(0)) return receiver.seen;
    return inputs.layout.view_harmonics > 0 ? receiver.inside.normal : glm::vec3(0);
}

TwoEstimates eval(const EffectInputs& inputs, const Prepared& prepared,
                  const TruthReceiver& receiver, std::uint64_t& rays) {
    const auto& truth = static_cast<const Truth&>(prepared);
    const BounceTruth* const other = truth.other ? &*truth.other : nullptr;
    if (model_of(inputs.own) == MultipleModel::dipole) {
        return integrate_multiple(
            truth.integral,
            {inputs.bake.scene, inputs.bake.rays, truth.suns, truth.smooth, truth.points, other},
            receiver.inside.position, {inputs.knobs.seed, receiver.key}, rays);
    }
    return walk_to_lights(
        truth.space,
        {inputs.bake.rays, truth.suns, truth.smooth, truth.lobe, profile_of(inputs.own).exit,
         truth.points, seen_of(inputs, receiver), other},
        receiver.inside,
        {inputs.layout.all_orders ? 1u : 2u, !inputs.layout.all_orders && other != nullptr,
         inputs.layout.fills_crossed, inputs.layout.layered && inputs.layout.crosses},
        inputs.knobs.seed, receiver.key, rays);
}

void warn_of_model(const EffectInputs& inputs, std::vector<formats::Diagnostic>& warnings) {
    if (inputs.layout.layered && model_of(inputs.own) != MultipleModel::walks) {
        warn_of_layers(inputs, warnings);
    }
    if (model_of(inputs.own) == MultipleModel::dipole) {
        warn_of_thin_parts(inputs, profile_of(inputs.own), warnings);
    }
    if (inputs.own.samples != nullptr) {
        const WalkCounts& counts =
            static_cast<const Samples&>(*inputs.own.samples).stage.walks.counts;
        if (auto warning =
                describe_unfinished(inputs.bake.scene.materials[inputs.material].name, counts)) {
            warnings.push_back(std::move(*warning));
        }
    }
}

constexpr std::array<DecisionRule, 4> kRules{
    {{"multiple", has_medium, decide_multiple, lay_out},
     {"multiple.layers", has_inner_media, decide_layers, lay_out_layers},
     {"multiple.model", has_medium,
      [](const PlanInput& input) {
          PlanEntry entry = decide_model(input);
          if (input.study != nullptr) describe_choice(choice_of(*input.study), entry);
          return entry;
      },
      lay_out_model},
     {"multiple.view", has_medium,
      [](const PlanInput& input) {
          PlanEntry entry = decide_views(input);
          if (input.study != nullptr) amend_views(choice_of(*input.study).views, input, entry);
          return entry;
      },
      lay_out_views}}};

}  // namespace

EffectDescriptor describe_multiple(Effect id) {
    return {.id = id,
            .name = "multiple",
            .help = "light scattered many times inside media",
            .inside_media = true,
            .rules = kRules,
            .knobs = kKnobs,
            .pilot = kPilot,
            .study = {.stage = "profiles", .run = study, .work = profile_work},
            .samples = {.stage = "samples of",
                        .by_subject = true,
                        .applies = needs_samples,
                        .run = take_samples,
                        .work = samples_work,
                        .bytes = sample_bytes,
                        .refine = refine_samples},
            .gather = {.applies = [](const RowLayout& layout) { return !layout.at_entry; },
                       .add = add,
                       .work = multiple_rows_work},
            .truth = {.reference = "the same model by Monte Carlo",
                      .is_expensive = true,
                      .make = make_truth,
                      .eval = eval,
                      .work =
                          [](const SubjectCost& cost, TruthEffort effort) {
                              return multiple_truth_work(cost, truth_points(effort));
                          }},
            .adds_other_light = true,
            .add_at_entry = add_at_entry,
            .warn_of_model = warn_of_model};
}

}  // namespace opaline::bake
