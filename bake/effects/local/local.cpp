#include "bake/effects/local/local.h"

#include <vector>

#include "bake/exchange/other_light.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

/// What a half space sends back of the irradiance at the receiver itself: no samples, no tree, no
/// light maps. factor[band][step]: radiance toward the viewer before its own transmittance, per
/// irradiance, at evenly spaced cosines of the light from 0 to 1.
struct Answer : Prepared {
    DirectionSet directions;
    std::vector<std::vector<float>> factor;
};

PreparedPtr prepare(const EffectInputs& inputs, std::uint64_t&) {
    auto answer = std::make_unique<Answer>();
    if (has_environment(inputs.bake.light)) {
        answer->directions = make_direction_set(inputs.knobs.cubemap_size);
    }
    std::vector<std::vector<double>> factor(inputs.layout.bands(),
                                            std::vector<double>(kCosineSteps + 1));
    const auto& effects = inputs.bake.effects.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        if (inputs.states[e].acts && effects[e].add_at_entry != nullptr) {
            effects[e].add_at_entry({inputs.bake, inputs.material, inputs.layout, inputs.knobs,
                                     inputs.context, inputs.states, inputs.states[e]},
                                    factor);
        }
    }
    for (const std::vector<double>& band : factor) {
        answer->factor.emplace_back(band.begin(), band.end());
    }
    return answer;
}

std::uint64_t add_environment(const EffectInputs& inputs, const GatherReceiver& receiver,
                              const DenseRow& row) {
    const auto& answer = static_cast<const Answer&>(*inputs.own.prepared);
    std::vector<float> dense(row.bands * row.size());
    const std::uint64_t rays = gather_banded_irradiance(inputs.outside(), answer.directions,
                                                        receiver.outside, answer.factor, dense);
    for (std::uint32_t band = 0; band < row.bands; ++band) {
        const std::span<float> own = std::span(dense).subspan(band * row.size(), row.size());
        formats::haar_forward_cube(own, row.cubemap_size);
        const std::span<float> to = row.plane(0, band);
        for (std::size_t k = 0; k < own.size(); ++k) {
            to[k] += own[k];
        }
    }
    return rays;
}

// int f(c) 2 c dc, by trapezoids: of diffuse light.
float mean_factor(std::span<const float> factor) {
    double sum = 0;
    const auto steps = static_cast<double>(factor.size() - 1);
    for (std::size_t i = 1; i < factor.size(); ++i) {
        const double weight = i + 1 == factor.size() ? 0.5 : 1;
        sum += weight * 2 * static_cast<double>(i) / steps * static_cast<double>(factor[i]);
    }
    return static_cast<float>(sum / steps);
}

std::uint64_t add(const EffectInputs& inputs, const GatherReceiver& receiver, const DenseRow& row) {
    const auto& answer = static_cast<const Answer&>(*inputs.own.prepared);
    const std::uint64_t rays =
        has_environment(inputs.bake.light) ? add_environment(inputs, receiver, row) : 0;
    OtherLightShare share;
    for (std::size_t band = 0; band < answer.factor.size(); ++band) {
        share.factor[band] = mean_factor(answer.factor[band]);
    }
    return rays + add_other_light(light_of(inputs), receiver.outside, {share}, row);
}

}  // namespace

EffectDescriptor describe_local(Effect id, std::span<const DecisionRule> rules) {
    return {.id = id,
            .name = "local",
            .rules = rules,
            .prepare = {.run = prepare},
            .gather = {.applies = [](const RowLayout& layout) { return layout.at_entry; },
                       .add = add,
                       .work =
                           [](const SubjectCost& c) {
                               return irradiance_work(c.input, c.receivers, c.layout.occluded);
                           }},
            .adds_other_light = true};
}

}  // namespace opaline::bake
