#include "bake/accuracy/pilot/pilot_rows.h"

#include <utility>

#include "bake/accuracy/stored_luminance.h"
#include "bake/base/ordered_parallel.h"
#include "bake/encode/share_rows.h"

namespace opaline::bake {
namespace {

// The pilot's receivers of a primitive, whose rows share their coefficients.
struct PilotPrimitive {
    RowShape shape;
    std::vector<formats::SparseRows> rows;  // of each encoding
    std::uint32_t receivers = 0;
};

RowShape shape_of(const RowLayout& layout) {
    return {layout.terms(), layout.bands(),
            layout.separate ? TermsSeen::together : TermsSeen::apart};
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
    if (!is_taken(own, state, Step::prepare, pilot_.bake.scene.materials[rows.subject->material],
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

std::vector<formats::SparseRows> PilotRows::encode(std::size_t receiver,
                                                   std::span<const RowEncoder> encoders) const {
    const PilotReceiver& r = receivers_[receiver];
    const SubjectRows& own = subjects_.at(r.material);
    const ReceiverSet& set = set_of(pilot_.bake.receivers, r.receiver);
    const std::size_t i = r.receiver - set.first;
    std::vector<float> values;
    const DenseRow row = shape_row(own.subject->layout, setting_.cubemap_size, values);
    gather_receiver(own.gatherers, set.outside[i], set.inside[i], place_[receiver], row);
    std::vector<formats::SparseRows> rows;
    for (const RowEncoder& encoder : encoders) {
        rows.push_back(empty_rows(encoder));
        encode_receiver(encoder, row, rows.back());
    }
    return rows;
}

PairsOfEncodings PilotRows::measure(std::span<const Encoding> encodings) const {
    std::vector<RowEncoder> encoders, wide;
    for (const Encoding& encoding : encodings) {
        encoders.push_back(
            make_row_encoder(setting_.cubemap_size, encoding.coefficients, encoding.code_bits));
        wide.push_back(widen(encoders.back()));
    }
    std::map<std::uint32_t, PilotPrimitive> primitives;  // by the first receiver
    std::vector<std::uint32_t> place;                    // of each receiver in its primitive
    for_each_block_in_order(
        receivers_.size(), 1, pilot_.context,
        [&](Range range) { return encode(range.begin, wide); },
        [&](Range range, std::vector<formats::SparseRows>&& rows) {
            const PilotReceiver& r = receivers_[range.begin];
            PilotPrimitive& own = primitives[set_of(pilot_.bake.receivers, r.receiver).first];
            place.push_back(own.receivers++);
            if (own.rows.empty()) {
                own.shape = shape_of(subjects_.at(r.material).subject->layout);
                own.rows = std::move(rows);
                return;
            }
            for (std::size_t e = 0; e < rows.size(); ++e) {
                formats::append_rows(own.rows[e], rows[e]);
            }
        });
    for (auto& [first, own] : primitives) {
        for (std::size_t e = 0; e < encoders.size(); ++e) {
            own.rows[e] = share_rows(std::move(own.rows[e]), own.shape, encoders[e]);
        }
    }
    PairsOfEncodings pairs(encodings.size());
    for_each_block_in_order(
        place.size(), 1, pilot_.context,
        [&](Range range) {
            const PilotReceiver& r = receivers_[range.begin];
            const ReceiverSet& set = set_of(pilot_.bake.receivers, r.receiver);
            const PilotPrimitive& own = primitives.at(set.first);
            const std::vector<float> h = view_of_rows(subjects_.at(r.material).subject->layout,
                                                      set.inside[r.receiver - set.first].normal);
            PairsOfEncodings found(encodings.size());
            for (std::size_t e = 0; e < encodings.size(); ++e) {
                const RowSource source{own.rows[e].view(),
                                       {0, own.receivers * own.shape.terms, own.shape.bands, 0, 0},
                                       place[range.begin] * own.shape.terms};
                append_pairs(relight_rows(source, h, pilot_.lights), r.truth, found[e]);
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
