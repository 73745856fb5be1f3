#include "bake/check/pilot/pilot_rows.h"

#include "bake/base/ordered_parallel.h"
#include "bake/check/stored_luminance.h"

namespace opaline::bake {
namespace {

// Luminance as the finished rows would give it.
Luminance relight_encoded(const DenseRow& row, std::span<const float> h, const RowEncoder& encoder,
                          std::span<const TestLight> lights) {
    formats::SparseRows rows = empty_rows(encoder);
    encode_receiver(encoder, row, rows);
    return relight_rows({rows.view(), {0, row.terms, row.bands, 0, 0}, 0}, h, lights);
}

}  // namespace

PilotRows::PilotRows(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                     const Knobs& setting)
    : pilot_(pilot), receivers_(receivers), setting_(setting), quiet_(pilot.context) {
    quiet_.on_progress = nullptr;
    for (const PilotReceiver& r : receivers) {
        SubjectRows& own = subjects_[r.material];
        const ReceiverSet& set = set_of(pilot.bake.receivers, r.receiver);
        place_.push_back(own.points.size());
        own.points.push_back(set.inside[r.receiver - set.first]);
    }
    for (SubjectState& subject : pilot.subjects) {
        if (const auto own = subjects_.find(subject.material); own != subjects_.end()) {
            own->second.subject = &subject;
        }
    }
    for (auto& [material, rows] : subjects_) {
        for (std::size_t e = 0; e < pilot.bake.effects.effects.size(); ++e) {
            prepare_subject(rows, e);
        }
        gather_anew(rows);
    }
}

// False: the subject has nothing to prepare for it.
bool PilotRows::prepare_subject(SubjectRows& rows, std::size_t effect) {
    const EffectDescriptor& own = pilot_.bake.effects.effects[effect];
    EffectState& state = rows.subject->effects[effect];
    if (!state.acts ||
        !is_taken(own, Step::prepare, pilot_.bake.scene.materials[rows.subject->material],
                  rows.subject->layout)) {
        return false;
    }
    std::uint64_t rays = 0;
    state.prepared =
        own.prepare.run(inputs_of(pilot_.bake, *rows.subject, effect, setting_, quiet_), rays);
    return true;
}

void PilotRows::gather_anew(SubjectRows& rows) {
    rows.gatherers = make_gatherers(pilot_.bake, *rows.subject, setting_, quiet_);
    gather_batches(rows.gatherers, rows.points);
}

void PilotRows::prepare(std::size_t effect) {
    for (auto& [material, rows] : subjects_) {
        if (prepare_subject(rows, effect)) {
            gather_anew(rows);
        }
    }
}

PairsOfEncodings PilotRows::measure(std::span<const Encoding> encodings) const {
    const std::span<const TestLight> lights = pilot_.lights;
    std::vector<RowEncoder> encoders;
    for (const Encoding& encoding : encodings) {
        encoders.push_back(
            make_row_encoder(setting_.cubemap_size, encoding.coefficients, encoding.code_bits));
    }
    PairsOfEncodings pairs(encodings.size());
    for_each_block_in_order(
        receivers_.size(), 1, pilot_.context,
        [&](Range range) {
            const PilotReceiver& r = receivers_[range.begin];
            const SubjectRows& own = subjects_.at(r.material);
            const ReceiverSet& set = set_of(pilot_.bake.receivers, r.receiver);
            const std::size_t i = r.receiver - set.first;
            const RowLayout& layout = own.subject->layout;
            std::vector<float> values;
            const DenseRow row = shape_row(layout, setting_.cubemap_size, values);
            gather_receiver(own.gatherers, set.outside[i], set.inside[i], place_[range.begin], row);
            const std::vector<float> h = view_of_rows(layout, set.inside[i].normal);
            PairsOfEncodings found(encodings.size());
            for (std::size_t e = 0; e < encodings.size(); ++e) {
                append_pairs(relight_encoded(row, h, encoders[e], lights), r.truth, found[e]);
            }
            return found;
        },
        [&](Range, const PairsOfEncodings& found) {
            for (std::size_t e = 0; e < found.size(); ++e) {
                pairs[e].insert(pairs[e].end(), found[e].begin(), found[e].end());
            }
        });
    return pairs;
}

}  // namespace opaline::bake
