#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/effects/rows/subject_states.h"

namespace opaline::bake {

/// True radiance of the receivers of one subject along their normals, but for the factors that
/// the runtime applies: the sum over the effects that fill its rows.
struct SubjectTruth {
    struct Part {
        const EffectDescriptor* effect;
        EffectInputs inputs;
        PreparedPtr truth;
    };
    std::vector<Part> parts;  ///< empty: its rows are black

    bool is_expensive() const;
    std::string name() const;       ///< of its effects: "multiple+single"
    std::string reference() const;  ///< in words
};
/// Points into the arguments.
SubjectTruth make_subject_truth(const BakeInputs& bake, const SubjectState& subject,
                                const Knobs& knobs, TruthEffort effort,
                                std::span<const TestLight> lights, const Context& context);

/// Whether the truth of a subject would have parts; whether it would be expensive.
bool has_truth(const BakeInputs& bake, const SubjectState& subject);
bool has_expensive_truth(const BakeInputs& bake, const SubjectState& subject);

/// `rays` counts up. Precondition: the truth has parts.
TwoEstimates eval_truth(const SubjectTruth& truth, const TruthReceiver& receiver,
                        std::uint64_t& rays);

}  // namespace opaline::bake
