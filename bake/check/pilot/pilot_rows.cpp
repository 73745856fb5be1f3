#include "bake/check/pilot/pilot_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

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

constexpr std::array<std::uint32_t, 12> kCoefficients{32,  48,  64,  96,  128,  192,
                                                      256, 384, 512, 768, 1024, 2048};
constexpr std::uint32_t kLeastOf16Bits = 768;

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

std::vector<Encoding> list_encodings(const Knobs& knobs) {
    const std::uint32_t texels = 6 * knobs.cubemap_size * knobs.cubemap_size;
    std::vector<Encoding> encodings;
    for (const std::uint32_t bits : {8u, 16u}) {
        for (const std::uint32_t m : kCoefficients) {
            // With few coefficients, 16-bit codes gain nothing.
            if (!knobs.coefficients_given && m < texels && (bits == 8 || m >= kLeastOf16Bits)) {
                encodings.push_back({m, bits});
            }
        }
        encodings.push_back(
            {knobs.coefficients_given ? knobs.coefficients : kAllCoefficients, bits});
    }
    // Approximate bytes: two for the index, and one or two for each of three bands.
    const auto bytes = [texels](const Encoding& e) {
        return std::min(e.coefficients, texels) * (e.code_bits == 8 ? 5 : 8);
    };
    std::stable_sort(encodings.begin(), encodings.end(),
                     [&](const Encoding& a, const Encoding& b) { return bytes(a) < bytes(b); });
    return encodings;
}

bool depends_on_trials(const BakeInputs& bake, const SubjectState& subject) {
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        if (subject.effects[e].acts && !bake.effects.effects[e].pilot.empty()) return true;
    }
    return false;
}

std::vector<PilotReceiver> select_receivers(const PilotScene& pilot,
                                            std::span<const PilotReceiver> receivers,
                                            bool depend_on_trials) {
    std::vector<PilotReceiver> selected;
    std::copy_if(receivers.begin(), receivers.end(), std::back_inserter(selected),
                 [&](const PilotReceiver& r) {
                     return depends_on_trials(pilot.bake, state_of(pilot.subjects, r.material)) ==
                            depend_on_trials;
                 });
    return selected;
}

FixedPairs measure_fixed(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                         const Knobs& knobs) {
    const std::vector<PilotReceiver> fixed = select_receivers(pilot, receivers, false);
    FixedPairs measured{list_encodings(knobs), {}};
    if (std::find(measured.encodings.begin(), measured.encodings.end(), kUnencoded) ==
        measured.encodings.end()) {
        measured.encodings.push_back(kUnencoded);
    }
    measured.pairs = PilotRows(pilot, fixed, knobs).measure(measured.encodings);
    return measured;
}

double find_fixed_floor(const FixedPairs& fixed, std::span<const PilotReceiver> receivers) {
    double reference = 0;
    for (const PilotReceiver& r : receivers) {
        for (std::size_t l = 0; l < r.truth.first.size(); ++l) {
            reference += r.truth.first[l] * r.truth.second[l];
        }
    }
    double square = 0;
    for (const CheckedPair& p : fixed.of(kUnencoded)) {
        square += p.error[0] * p.error[1];
    }
    return reference > 0 ? std::sqrt(std::max(0.0, square / reference)) : 0.0;
}

std::vector<CheckedPair> insert_fixed(const PilotScene& pilot,
                                      std::span<const PilotReceiver> receivers,
                                      std::span<const CheckedPair> measured,
                                      const FixedPairs& fixed, const Encoding& encoding) {
    const std::size_t lights = pilot.lights.size();
    std::span<const CheckedPair> others = fixed.of(encoding);
    std::vector<CheckedPair> pairs;
    for (const PilotReceiver& r : receivers) {
        std::span<const CheckedPair>& from =
            depends_on_trials(pilot.bake, state_of(pilot.subjects, r.material)) ? measured : others;
        if (from.size() < lights) {
            break;  // cancelled
        }
        pairs.insert(pairs.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(lights));
        from = from.subspan(lights);
    }
    return pairs;
}

}  // namespace opaline::bake
