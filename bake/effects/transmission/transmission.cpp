#include "bake/effects/transmission/transmission.h"

#include <array>
#include <cmath>
#include <string>

#include "bake/effects/transmission/rules_transmission.h"
#include "bake/effects/transmission/straight_rows.h"
#include "bake/effects/transmission/transmission_costs.h"
#include "bake/effects/transmission/transmission_knobs.h"
#include "bake/effects/transmission/true_transmission.h"

namespace opaline::bake {
namespace {

constexpr std::array<DecisionRule, 2> kRules{
    {{"transmission", has_medium, decide_transmission,
      [](const PlanEntry& entry, RowLayout& layout) {
          layout.constant = layout.constant || entry.on;
          layout.fills_crossed = !entry.on && entry.all_orders;
      }},
     {"transmission.view", has_medium, decide_straight_views,
      [](const PlanEntry& entry, RowLayout& layout) {
          layout.straight_harmonics = entry.on ? entry.terms : 0;
      }}}};
constexpr std::array<const KnobSpec*, 2> kKnobs{&kStraightViews, &kStraightTerms};

struct Body : Prepared {
    StraightBody body;
};

PreparedPtr prepare(const EffectInputs& inputs, std::uint64_t&) {
    auto prepared = std::make_unique<Body>();
    prepared->body = make_straight_body(inputs);
    return prepared;
}

std::uint64_t add(const EffectInputs& inputs, const GatherReceiver& receiver, const DenseRow& row) {
    return add_straight(static_cast<const Body&>(*inputs.own.prepared).body, receiver.inside,
                        whole(inputs.knobs, kStraightViews), inputs.knobs.seed, inputs.layout, row,
                        inputs.light());
}

LookThrough make_look_through(const EffectInputs& inputs) {
    return [body = make_straight_body(inputs), views = whole(inputs.knobs, kStraightViews),
            seed = inputs.knobs.seed](const BodyPoint& point, std::uint64_t& rays) {
        return look_through(body, point, views, seed, rays);
    };
}

struct Truth : Prepared {
    StraightBody body;
    StraightTruth truth;
};

// For each of two estimates.
std::uint32_t truth_views(TruthEffort effort) {
    return effort.target >= 0.03 ? 512 : 1024;
}

PreparedPtr make_truth(const EffectInputs& inputs, TruthEffort effort,
                       std::span<const TestLight> lights) {
    auto truth = std::make_unique<Truth>();
    truth->body = make_straight_body(inputs);
    truth->body.sky = &inputs.bake.rays;  // whatever the plan says of what stands before the light
    truth->truth = {lights, make_smooth_lights(lights), truth_views(effort),
                    straight_terms(inputs.layout)};
    if (const OtherLight* const light = inputs.light();
        light != nullptr && light->make_seen_truth) {
        truth->truth.surfaces = light->make_seen_truth(lights);
    }
    return truth;
}

TwoEstimates eval(const EffectInputs& inputs, const Prepared& prepared,
                  const TruthReceiver& receiver, std::uint64_t& rays) {
    const auto& truth = static_cast<const Truth&>(prepared);
    return see_lights_through(truth.body, truth.truth, receiver.inside, receiver.seen,
                              inputs.knobs.seed, receiver.key, rays);
}

// What is behind a clear body is not seen sharply.
void warn_of_model(const EffectInputs& inputs, std::vector<formats::Diagnostic>& warnings) {
    constexpr double kWorthSaying = 0.1;
    const MaterialFacts& facts = inputs.bake.facts.material[inputs.material];
    const double share = typical_share(inputs.medium(), facts);
    if (share < kWorthSaying) {
        return;
    }
    const std::uint32_t terms = straight_terms(inputs.layout);
    warnings.push_back(formats::make_warning(
        "", "material '" + inputs.bake.scene.materials[inputs.material].name + "'",
        std::string(facts.has_thickness() ? "some " : "up to ") +
            std::to_string(static_cast<int>(std::lround(100 * share))) +
            " % of even light crosses the body unscattered, and " +
            (terms == 1 ? "one row shows its mean over all views"
                        : std::to_string(terms) + " rows blur it over tens of degrees of view") +
            ": its energy is right, but what stands behind is not seen sharply, and suns shine "
            "through it evenly",
        "measure it with --check-model"));
}

}  // namespace

EffectDescriptor describe_transmission(Effect id) {
    return {.id = id,
            .name = "transmission",
            .help = "light that crosses media unscattered",
            .inside_media = true,
            .rules = kRules,
            .knobs = kKnobs,
            .prepare = {.run = prepare},
            .gather = {.add = add,
                       .work =
                           [](const SubjectCost& cost) {
                               return straight_rows_work(cost, cost.input.knobs[kStraightViews]);
                           }},
            .truth = {.reference = "random views through the body",
                      .is_expensive = true,
                      .make = make_truth,
                      .eval = eval,
                      .work =
                          [](const SubjectCost& cost, TruthEffort effort) {
                              return straight_truth_work(cost, 2.0 * truth_views(effort));
                          }},
            .held_light = formats::TermSet::unscattered,
            .make_look_through = make_look_through,
            .warn_of_model = warn_of_model};
}

}  // namespace opaline::bake
