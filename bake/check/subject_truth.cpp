#include "bake/check/subject_truth.h"

#include <algorithm>
#include <cassert>
#include <numbers>
#include <vector>

#include "bake/exchange/other_light.h"
#include "bake/receivers/other_side.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

bool is_part(const EffectDescriptor& effect, const EffectState& state) {
    return state.acts && effect.truth.make != nullptr;
}

template <class Predicate>
bool any_part(const BakeInputs& bake, const SubjectState& subject, Predicate&& predicate) {
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        if (is_part(bake.effects.effects[e], subject.effects[e]) &&
            predicate(bake.effects.effects[e])) {
            return true;
        }
    }
    return false;
}

std::string join(const std::vector<SubjectTruth::Part>& parts, const char* separator,
                 std::string_view (*text)(const EffectDescriptor&)) {
    std::string all;
    for (const SubjectTruth::Part& part : parts) {
        all += (all.empty() ? "" : separator) + std::string(text(*part.effect));
    }
    return all;
}

void add(Luminance& sum, const Luminance& more) {
    for (std::size_t l = 0; l < sum.size(); ++l) {
        sum[l] += more[l];
    }
}

// The first of the published lights is even, of radiance 1.
constexpr std::size_t kEven = 1;

SentLight finer(const SentLight& light, std::uint64_t number) {
    SentLight own = light;
    own.side *= 2;
    own.seed += number;
    return own;
}

// Radiance [W m^-2 sr^-1] per unit of light from each cell, as luminance; `even`: of a medium.
std::vector<float> answer_cells(const SentTruth& truth, const SentLight& light,
                                const TruthReceiver& at, double even, std::uint64_t& rays) {
    const std::size_t cells = light.cells.size();
    const SentIrradiance front = gather_sent_light(light, at.outside);
    SentIrradiance back;
    rays += front.rays;
    if (truth.material.sheet) {
        back = gather_sent_light(light, other_side(at.outside, at.inside));
        rays += back.rays;
    }
    const auto in_band = [&](std::uint32_t band, std::size_t cell) {
        const auto bands = static_cast<std::uint32_t>(light.bands());
        const AnswerToSent answer =
            truth.even ? answer_of_medium(even, front.open, even)
                       : answer_of_surface(truth.material, at.behind ? 1 : 0, band, bands);
        const std::size_t i = (bands == 1 ? 0 : band * cells) + cell;
        return answer.front * front.rows[i] + (back.rows.empty() ? 0 : answer.back * back.rows[i]);
    };
    std::vector<float> luminance(cells);
    for (std::size_t c = 0; c < cells; ++c) {
        luminance[c] = light.bands() == 1
                           ? in_band(0, c)
                           : formats::luminance({in_band(0, c), in_band(1, c), in_band(2, c)});
    }
    return luminance;
}

}  // namespace

bool SubjectTruth::is_expensive() const {
    return std::any_of(parts.begin(), parts.end(),
                       [](const Part& p) { return p.effect->truth.is_expensive; });
}

std::string SubjectTruth::name() const {
    std::string all = join(parts, "+", [](const EffectDescriptor& e) { return e.name; });
    for (const Part& part : parts) {
        const OtherLight* const light = light_of(part.inputs);
        if (part.effect->adds_other_light && light != nullptr && !light->name.empty()) {
            return all + "+" + std::string(light->name);
        }
    }
    return all;
}

std::string SubjectTruth::reference() const {
    return join(parts, ", and ", [](const EffectDescriptor& e) { return e.truth.reference; });
}

bool has_truth(const BakeInputs& bake, const SubjectState& subject) {
    return any_part(bake, subject, [](const EffectDescriptor&) { return true; });
}

bool has_expensive_truth(const BakeInputs& bake, const SubjectState& subject) {
    return any_part(bake, subject, [](const EffectDescriptor& e) { return e.truth.is_expensive; });
}

SubjectTruth make_subject_truth(const BakeInputs& bake, const SubjectState& subject,
                                const Knobs& knobs, TruthEffort effort,
                                std::span<const TestLight> lights, const Context& context) {
    SubjectTruth truth;
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        const EffectDescriptor& effect = bake.effects.effects[e];
        if (is_part(effect, subject.effects[e])) {
            const EffectInputs inputs = inputs_of(bake, subject, e, knobs, context);
            truth.parts.push_back({&effect, inputs, effect.truth.make(inputs, effort, lights)});
        }
    }
    return truth;
}

TwoEstimates eval_truth(const SubjectTruth& truth, const TruthReceiver& receiver,
                        std::uint64_t& rays) {
    assert(!truth.parts.empty());
    TwoEstimates sum;
    for (const SubjectTruth::Part& part : truth.parts) {
        const TwoEstimates own = part.effect->truth.eval(part.inputs, *part.truth, receiver, rays);
        if (sum.first.empty()) {
            sum = own;
        } else {
            add(sum.first, own.first);
            add(sum.second, own.second);
        }
    }
    return sum;
}

SentTruth make_sent_truth(const FinishedBake& bake, const SentLight& light,
                          const SubjectState& subject, const Context& context) {
    SentTruth truth{{finer(light, 1), finer(light, 2)},
                    bake.inputs.scene.materials[subject.material],
                    bake.knobs.cubemap_size,
                    std::nullopt};
    if (subject.layout.translucent) {
        truth.even = make_subject_truth(bake.inputs, subject, bake.knobs, {},
                                        bake.lights.first(kEven), context);
    }
    return truth;
}

std::uint64_t add_sent_truth(const SentTruth& truth, const TruthReceiver& at,
                             std::span<const TestLight> lights, TwoEstimates& luminance) {
    std::uint64_t rays = 0;
    double even = 0;
    if (truth.even) {
        const TwoEstimates seen = eval_truth(*truth.even, at, rays);
        even = 0.5 * (seen.first.front() + seen.second.front());
    }
    for (const std::size_t i : {0u, 1u}) {
        const SentLight& light = truth.light[i];
        const std::vector<float> row = transform_cells(answer_cells(truth, light, at, even, rays),
                                                       light.cells.n, truth.cubemap_size);
        Luminance& to = i == 0 ? luminance.first : luminance.second;
        for (std::size_t l = 0; l < lights.size(); ++l) {
            to[l] += relit(row, lights[l].coarse);
        }
    }
    return rays;
}

}  // namespace opaline::bake
