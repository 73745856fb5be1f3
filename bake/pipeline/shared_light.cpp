#include "bake/pipeline/shared_light.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bake/check/error_warnings.h"
#include "bake/effects/rows/medium_rows.h"
#include "bake/exchange/exchange_points.h"

namespace opaline::bake {
namespace {

LightInputs inputs_for(const LightRequest& request) {
    return {.bake = request.bake,
            .knobs = request.knobs,
            .context = request.context,
            .layouts = request.layouts,
            .acts = std::vector<std::uint8_t>(request.layouts.size()),
            .onlookers = request.onlookers};
}

std::shared_ptr<const BounceLight> solve(const LightRequest& request, const LightInputs& inputs,
                                         Bounces bounces, std::uint64_t& rays) {
    ExchangePoints points = place_exchange(inputs, rays);
    const auto media =
        ask_media(request.bake, request.knobs, request.context, points, request.subjects, rays);
    return solve_exchange(inputs, std::move(points), media, rays, bounces);
}

}  // namespace

std::optional<OtherLight> find_shared_light(const LightRequest& request) {
    const auto& effects = request.bake.effects.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        const EffectDescriptor& effect = effects[e];
        LightInputs inputs = inputs_for(request);
        for (const SubjectState& subject : request.subjects) {
            inputs.acts[subject.material] = subject.effects[e].acts ? 1 : 0;
        }
        if (effect.exchange_rays == nullptr || std::ranges::count(inputs.acts, 1) == 0) continue;
        inputs.rays_of_receiver = effect.exchange_rays(request.knobs);
        const std::string name(effect.name);
        OtherLight light{.name = effect.name};
        light.surfaces = run_stage(
            request.log, name, name + ": scatterers",
            [&](std::uint64_t& rays) { return solve(request, inputs, Bounces::all, rays); });
        if (!light.surfaces) continue;
        light.bands = light.surfaces->bands;
        for (const std::uint8_t acts : inputs.acts) {
            light.unreached.push_back(acts == 0 ? 1 : 0);
        }
        return light;
    }
    return std::nullopt;
}

std::shared_ptr<const BounceLight> find_surface_light(const LightRequest& request) {
    return run_stage(request.log, "surfaces that volumes see", "surface-volume: scatterers",
                     [&](std::uint64_t& rays) {
                         return solve(request, inputs_for(request), Bounces::none, rays);
                     });
}

std::shared_ptr<const BounceLight> find_light_for_lamps(const LightRequest& request) {
    // Lamps light surfaces whose light of the sky is left out, too.
    std::vector<RowLayout> layouts(request.layouts.begin(), request.layouts.end());
    for (RowLayout& layout : layouts) {
        layout.constant = layout.constant || !layout.translucent;
    }
    LightInputs inputs = inputs_for(request);
    inputs.layouts = layouts;
    for (const EffectDescriptor& effect : request.bake.effects.effects) {
        if (effect.exchange_rays == nullptr) continue;
        inputs.rays_of_receiver = effect.exchange_rays(request.knobs);
    }
    return run_stage(request.log, "surfaces that emitters light", [&](std::uint64_t& rays) {
        return solve(request, inputs, Bounces::of_lamps, rays);
    });
}

std::optional<formats::Diagnostic> describe_unsettled(const OtherLight& light) {
    constexpr double kMost = 0.01;
    const SolveReport& report = light.surfaces->report;
    if (!(report.remaining > kMost)) return std::nullopt;
    return formats::make_warning(
        "", std::string(light.name),
        "after " + std::to_string(report.bounces) + " bounces " + error_percent(report.remaining) +
            " of the light between surfaces was still to come and is extrapolated",
        "let the surfaces absorb more: in a closed room of albedo 1 light never ends");
}

}  // namespace opaline::bake
