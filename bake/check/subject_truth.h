#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/check/measure_error.h"
#include "bake/effects/rows/subject_states.h"
#include "bake/effects/volumes/sent_light.h"

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

/// What volumes scatter to points of one subject, for the check of its rows: from the nodes that
/// the file has, whose own error is that of volumes, by four times the rays.
struct SentTruth {
    std::array<SentLight, 2> light;  ///< for two independent estimates
    const formats::Material& material;
    std::uint32_t cubemap_size = 0;    ///< of the lights
    std::optional<SubjectTruth> even;  ///< of a medium under even light that no volume dims
};
/// `bake` must outlive the result.
SentTruth make_sent_truth(const FinishedBake& bake, const SentLight& light,
                          const SubjectState& subject, const Context& context);

/// Adds the luminance of that light. Returns the rays traced.
std::uint64_t add_sent_truth(const SentTruth& truth, const TruthReceiver& at,
                             std::span<const TestLight> lights, TwoEstimates& luminance);

}  // namespace opaline::bake
