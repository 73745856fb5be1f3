#include "bake/effects/single/single.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "bake/effects/single/rules_single.h"
#include "bake/effects/single/single_knobs.h"
#include "bake/effects/single/single_stage.h"
#include "bake/effects/single/true_single.h"
#include "bake/physics/entry.h"
#include "bake/physics/path_quadrature.h"
#include "bake/physics/phase_series.h"
#include "bake/plan/medium_exitance.h"
#include "bake/plan/stage_work.h"
#include "bake/receivers/body_points.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr double kGreyLookUp = 0.8, kGreyUnpacking = 0.4;  // one band to three; measured

// Light maps: of the mesh that they draw; into one; a pixel of one, to clear and fill.
constexpr CostBySize kBodyTriangle{2.5e-6, 3.3e-6};
constexpr double kDrawTriangle = 3.1e-8, kDrawPixel = 3.4e-9;
constexpr CostBySize kPlaceNodes{3.2e-6, 3.9e-6};  // the inward path of a receiver
// Of a node in a light map, rays for undecided nodes included; each term beyond the first.
constexpr CostBySize kLookUp{9e-8, 9e-8};
constexpr double kLookUpTerm = 9.3e-9;
constexpr double kUnpackTexel = 7.7e-9;           // from packed rows into a receiver's, per term
constexpr CostBySize kEntryPacket{6.2e-6, 1e-5};  // sixteen rays out of a body, with their entries

double texels(std::uint32_t n) {
    return static_cast<double>(formats::cubemap_texels(n));
}

// Work of the steps of this effect (single.cpp).
Work light_maps_work(const SubjectCost& cost) {
    return cost.input.knobs.exact_rays
               ? Work{}
               : Work{0, cost.facts.triangles * kBodyTriangle.at(cost.input.triangles)};
}

Work single_rows_work(const SubjectCost& cost) {
    const CostInput& input = cost.input;
    const MaterialFacts& facts = cost.facts;
    const std::uint32_t terms = cost.layout.harmonics;
    const double receivers = cost.receivers;
    const bool grey = cost.layout.bands() == 1;
    const double coarse = texels(whole(input.knobs, kSingleCubemap));
    const double nodes = receivers * input.knobs[kDepthSamples];
    const double unpacked = receivers * terms * coarse * kUnpackTexel * (grey ? kGreyUnpacking : 1);
    if (input.knobs.exact_rays) {
        constexpr double kRaysPerTexel = 4, kRaysPerPacket = 16;
        return {0,
                nodes * coarse * kRaysPerTexel / kRaysPerPacket * kEntryPacket.at(input.triangles) +
                    unpacked};
    }
    // Each batch renders all views anew.
    const double batches = std::ceil(receivers * coarse * terms * (grey ? 2 : 4) / kBatchBytes);
    const double edge =
        std::sqrt(facts.area / std::max(facts.triangles, 1.0) * 4 / std::numbers::sqrt3);
    const double pixels = std::pow(
        std::clamp(
            edge > 0 ? 4 * static_cast<double>(glm::length(facts.high - facts.low)) / edge : 128.0,
            128.0, 2048.0),
        2);
    const double view = input.triangles * kDrawTriangle + pixels * kDrawPixel;
    return {0, receivers * kPlaceNodes.at(input.triangles) + batches * coarse * view +
                   nodes * coarse * (grey ? kGreyLookUp : 1) *
                       (kLookUp.at(input.triangles) + (terms - 1) * kLookUpTerm) +
                   unpacked};
}

Work single_truth_work(const SubjectCost& cost, double depth_samples) {
    constexpr double kPackets = 97;  // true_single.cpp: a cube map of 8, and the suns
    return {0, cost.receivers * depth_samples * kPackets * kEntryPacket.at(cost.input.triangles)};
}

constexpr std::array<const KnobSpec*, 4> kKnobs{&kDepthSamples, &kSingleCubemap, &kPhaseTerms,
                                                &kPhaseTolerance};

using Setting = PilotLadder::Setting;
constexpr std::array<Setting, 2> kFinest{{{&kDepthSamples, 10}, {&kSingleCubemap, 16}}};
constexpr std::array<std::array<Setting, 2>, 2> kSettings{
    {{{{&kDepthSamples, 4}, {&kSingleCubemap, 8}}},
     {{{&kDepthSamples, 6}, {&kSingleCubemap, 16}}}}};
constexpr std::array<std::span<const Setting>, 2> kLevels{kSettings[0], kSettings[1]};
constexpr std::array<PilotLadder, 1> kPilot{{{&kDepthSamples, kLevels, kFinest, 0.1}}};

struct Stage : Prepared {
    SingleStage stage;
};
struct Batch : Prepared {
    SingleBatch batch;
};

const SingleStage& stage_of(const Prepared& prepared) {
    return static_cast<const Stage&>(prepared).stage;
}

bool leaves_elsewhere(const RowLayout& layout) {
    return !layout.at_entry;
}

// Rays inside the body need all triangles, also where nothing stands before the light.
PreparedPtr prepare(const EffectInputs& inputs, std::uint64_t&) {
    const Knobs& knobs = inputs.knobs;
    auto prepared = std::make_unique<Stage>();
    prepared->stage = prepare_single(
        inputs.bake.scene, inputs.bake.rays, inputs.material,
        {std::min(whole(knobs, kSingleCubemap), knobs.cubemap_size), whole(knobs, kDepthSamples),
         inputs.layout.harmonics, knobs.exact_rays, inputs.layout.bands()},
        inputs.context);
    return prepared;
}

PreparedPtr gather_batch(const EffectInputs& inputs, std::span<const BodyPoint> points,
                         std::uint64_t& rays) {
    auto batch = std::make_unique<Batch>();
    std::vector<BodyPoint> beside;
    std::ranges::transform(points, std::back_inserter(beside), step_aside);
    batch->batch = gather_single_batch(stage_of(*inputs.own.prepared), inputs.bake.rays, beside,
                                       inputs.context);
    rays += batch->batch.rows.counts.rays;
    return batch;
}

std::uint64_t add(const EffectInputs& inputs, const GatherReceiver& receiver, const DenseRow& row) {
    const SingleBatch& batch = static_cast<const Batch&>(*receiver.batch).batch;
    const std::uint32_t m = stage_of(*inputs.own.prepared).directions.cubemap_size;
    add_single(batch, receiver.place, m, inputs.layout.first_harmonic(), row);
    return 0;
}

// alpha / (4 pi) (Ft J / c) c' / (1 + c'): the integral along a path without end, isotropic.
void add_at_entry(const EffectInputs& inputs, std::span<std::vector<double>> factor) {
    constexpr double kEven = 0.25 * std::numbers::inv_pi;
    const formats::Medium& medium = inputs.medium();
    const PathMedium path = make_path_medium(medium);
    const Interface<double> boundary{static_cast<double>(medium.eta),
                                     medium.fidelity != formats::Medium::Fidelity::paper};
    for (std::size_t b = 0; b < factor.size(); ++b) {
        const double albedo = path.sigma_t[b] > 0 ? path.sigma_s[b] / path.sigma_t[b] : 0;
        for (std::uint32_t i = 1; i <= kCosineSteps; ++i) {
            const double cosine = static_cast<double>(i) / kCosineSteps;
            const Entry<double> entry = enter(cosine, boundary);
            factor[b][i] += kEven * albedo * entry.throughput / cosine * entry.refracted_cosine /
                            (1 + entry.refracted_cosine);
        }
    }
}

struct Truth : Prepared {
    SingleQuadrature quadrature;
};

// A self-check looks twice as closely as the bake; a pilot, as closely as its target asks for.
double truth_depths(const Knobs& knobs, TruthEffort effort) {
    return effort.target >= 0.03 ? 8 : effort.target > 0 ? 16 : 2 * knobs[kDepthSamples];
}

PreparedPtr make_truth(const EffectInputs& inputs, TruthEffort effort,
                       std::span<const TestLight> lights) {
    auto truth = std::make_unique<Truth>();
    truth->quadrature =
        make_single_quadrature(inputs.bake.scene, inputs.material,
                               static_cast<std::uint32_t>(truth_depths(inputs.knobs, effort)),
                               lights, inputs.bake.between);
    return truth;
}

TwoEstimates eval(const EffectInputs& inputs, const Prepared& prepared,
                  const TruthReceiver& receiver, std::uint64_t& rays) {
    const SingleQuadrature& quadrature = static_cast<const Truth&>(prepared).quadrature;
    if (receiver.inside.normal == glm::vec3(0)) {
        return {Luminance(quadrature.lights), Luminance(quadrature.lights)};
    }
    const Luminance once =
        integrate_single(quadrature, inputs.bake.rays, step_aside(receiver.inside), rays);
    return {once, once};
}

// Before any phase function is expanded.
double typical_rows(const formats::Medium& medium, const Knobs& knobs) {
    constexpr double kTypicalTerms = 4;
    return medium.phase.type == formats::PhaseFunction::Type::isotropic ? 1
           : knobs[kPhaseTerms] > 0                                     ? knobs[kPhaseTerms]
                                                                        : kTypicalTerms;
}

// The largest number of terms is too few for the tolerance asked for: their sum is negative in some
// directions, and single scattering with it.
void warn_of_short_series(const PlanInput& input, const PlanEntry& entry,
                          std::vector<formats::Diagnostic>& warnings) {
    constexpr std::uint32_t kMostTerms = 25, kDegrees = 5;
    if (entry.terms != kMostTerms) return;
    const formats::Medium& medium = *input.material.medium;
    const double error = phase_rms_relative(expand_phase(medium.phase, kDegrees), kMostTerms);
    if (error * share_scattered_once(medium) > input.knobs[kPhaseTolerance]) {
        warnings.push_back(formats::make_warning(
            "", entry.subject.name,
            "the phase function is too narrow for " + std::to_string(kMostTerms) +
                " terms, the most there are: they err by " +
                std::to_string(static_cast<int>(std::round(100 * error))) +
                " % of its RMS, and single scattering is wrong, in some views negative and shown "
                "as black",
            "leave it out with --effects multiple, or lower the mean cosine g and keep "
            "(1 - g) sigma_s"));
    }
}

// No other knob can make up for too few terms of a phase function.
void warn_of_terms(const PlanInput& input, const PlanEntry& entry,
                   std::vector<formats::Diagnostic>& warnings) {
    if (entry.terms == 0) return;
    warn_of_short_series(input, entry, warnings);
    const std::uint32_t needed = needed_terms(*input.material.medium, input.knobs);
    if (needed > entry.terms) {
        warnings.push_back(formats::make_warning(
            "", entry.subject.name,
            "--phase-terms " + std::to_string(entry.terms) + " was taken as given; " +
                (input.knobs.error_target > 0 ? "--error" : "the quality") + " needs " +
                std::to_string(needed),
            "leave --phase-terms out, or give --phase-terms " + std::to_string(needed)));
    }
}

constexpr std::array<DecisionRule, 2> kRules{
    {{"single", has_medium, decide_single,
      [](const PlanEntry& entry, RowLayout& layout) {
          layout.harmonics = std::max(layout.harmonics, entry.on ? 1u : 0u);
          layout.all_orders = !entry.on && entry.all_orders;
      }},
     {"single.terms", is_anisotropic, decide_terms,
      [](const PlanEntry& entry, RowLayout& layout) {
          layout.harmonics = entry.on && layout.harmonics > 0
                                 ? std::max(layout.harmonics, entry.terms)
                                 : layout.harmonics;
      },
      warn_of_terms}}};

}  // namespace

EffectDescriptor describe_single(Effect id) {
    return {.id = id,
            .name = "single",
            .help = "light scattered once inside media",
            .inside_media = true,
            .rules = kRules,
            .knobs = kKnobs,
            .pilot = kPilot,
            .prepare = {.stage = "light maps of",
                        .by_subject = true,
                        .applies = [](const formats::Material&,
                                      const RowLayout& layout) { return leaves_elsewhere(layout); },
                        .run = prepare,
                        .work = light_maps_work},
            .gather = {.applies = leaves_elsewhere,
                       .batch_size =
                           [](const Prepared& prepared, std::size_t bytes) {
                               return receivers_per_batch(stage_of(prepared), bytes);
                           },
                       .gather_batch = gather_batch,
                       .add = add,
                       .work = single_rows_work,
                       .typical_rows = typical_rows},
            .truth = {.reference = "rays to twice as many depths",
                      .is_expensive = true,
                      .make = make_truth,
                      .eval = eval,
                      .work =
                          [](const SubjectCost& cost, TruthEffort effort) {
                              return single_truth_work(cost,
                                                       truth_depths(cost.input.knobs, effort));
                          }},
            .add_at_entry = add_at_entry};
}

}  // namespace opaline::bake
