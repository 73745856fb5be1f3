#include "bake/check/subject_truth.h"

#include <algorithm>
#include <cassert>

#include "bake/exchange/other_light.h"

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

}  // namespace opaline::bake
