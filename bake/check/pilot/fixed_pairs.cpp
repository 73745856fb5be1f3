#include "bake/check/pilot/fixed_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/check/pilot/pilot_rows.h"

namespace opaline::bake {
namespace {

constexpr std::array<std::uint32_t, 12> kCoefficients{32,  48,  64,  96,  128,  192,
                                                      256, 384, 512, 768, 1024, 2048};
constexpr std::uint32_t kLeastOf16Bits = 768;

}  // namespace

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
