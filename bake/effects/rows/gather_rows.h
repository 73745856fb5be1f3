#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/rows/subject_states.h"
#include "bake/effects/volumes/complete_rows.h"
#include "bake/encode/row_sink.h"

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

/// One effect at work on the receivers of a subject.
struct Gatherer {
    const EffectDescriptor* effect;
    EffectInputs inputs;
    PreparedPtr batch{};  ///< of the receivers at hand, where the effect gathers in batches
};

/// The effects that fill rows of a subject, without batches. They point into all arguments.
std::vector<Gatherer> make_gatherers(const BakeInputs& bake, const SubjectState& subject,
                                     const Knobs& knobs, const Context& context);

/// Gathers the batches of some receivers. Returns the rays traced.
std::uint64_t gather_batches(std::vector<Gatherer>& gatherers, std::span<const BodyPoint> points);

/// A receiver's dense rows: the sum over all effects, overwritten. Any thread. Returns the rays
/// traced.
std::uint64_t gather_receiver(std::span<const Gatherer> gatherers, const Receiver& outside,
                              const BodyPoint& inside, std::size_t place, const DenseRow& row);

/// A dense row of a subject's shape over `values`, which is resized.
DenseRow shape_row(const RowLayout& layout, std::uint32_t cubemap_size, std::vector<float>& values);

/// The rows to make.
struct RowJob {
    const ReceiverSet& set;
    const RowLayout& layout;
    const RowEncoder& encoder;
    std::uint32_t total = 0;  ///< receivers of all sets, for the progress
    std::size_t batch_bytes = static_cast<std::size_t>(kBatchBytes);
    bool measures_errors = false;
    /// With batches that hold all receivers of the set in its order, the first at `place`
    /// (SharedBatches); null: the set gathers batches of its own.
    const std::vector<Gatherer>* shared = nullptr;
    std::size_t place = 0;
    /// Before the receivers, of the `material`; null: none.
    const VolumesBefore* volumes = nullptr;
    const formats::Material* material = nullptr;
};

struct GatheredRows {
    formats::SparseRows rows;
    std::vector<float> receiver_error;  ///< of encoding (receiver_error.h), where it is measured
};

/// The encoded rows of a set's receivers in the order of the set; fewer, in no order, if the
/// context is cancelled or they hold more than 2^32 - 1 coefficients. `rays` counts up.
GatheredRows gather_rows(const RowJob& job, std::vector<Gatherer> gatherers, const Context& context,
                         std::uint64_t& rays);

}  // namespace opaline::bake
