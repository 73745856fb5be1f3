#include "bake/pipeline/shared_light.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bake/exchange/exchange_points.h"
#include "bake/rows/medium_rows.h"

namespace opaline::bake {

std::optional<OtherLight> find_shared_light(const BakeInputs& bake, const Knobs& knobs,
                                            const Context& context,
                                            std::span<const RowLayout> layouts,
                                            std::vector<SubjectState>& subjects, StageLog& log) {
    for (std::size_t e = 0; e < bake.effects.effects.size(); ++e) {
        const EffectDescriptor& effect = bake.effects.effects[e];
        LightInputs inputs{bake, knobs, context, layouts,
                           std::vector<std::uint8_t>(layouts.size())};
        for (const SubjectState& subject : subjects) {
            inputs.acts[subject.material] = subject.effects[e].acts ? 1 : 0;
        }
        if (effect.exchange_rays == nullptr || std::ranges::count(inputs.acts, 1) == 0) continue;
        inputs.rays_of_receiver = effect.exchange_rays(knobs);
        const std::string name(effect.name);
        OtherLight light{.name = effect.name};
        light.surfaces = run_stage(log, name, name + ": scatterers", [&](std::uint64_t& rays) {
            ExchangePoints points = place_exchange(inputs, rays);
            const auto media = ask_media(bake, knobs, context, points, subjects, rays);
            return solve_exchange(inputs, std::move(points), media, rays);
        });
        if (!light.surfaces) continue;
        light.bands = light.surfaces->bands;
        for (const std::uint8_t acts : inputs.acts) {
            light.unreached.push_back(acts == 0 ? 1 : 0);
        }
        return light;
    }
    return std::nullopt;
}

}  // namespace opaline::bake
