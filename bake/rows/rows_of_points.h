#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/rows/subject_states.h"

namespace opaline::bake {

/// Frees all state of a subject except its studies.
void forget_samples(SubjectState& subject);

/// Dense rows of any points of one studied subject: terms * bands * 6 n n Haar coefficients each, n
/// of the knobs. Takes its samples for them alone and leaves it without. `outside` and `inside`:
/// the same points. Some are 0 once the context is cancelled.
std::vector<std::vector<float>> rows_of_points(const BakeInputs& bake, const Knobs& knobs,
                                               const Context& context, SubjectState& subject,
                                               std::span<const Receiver> outside,
                                               std::span<const BodyPoint> inside,
                                               std::uint64_t& rays);

}  // namespace opaline::bake
