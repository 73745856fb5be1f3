#include "bake/pilot/opaque_pairs.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/pilot/pilot_rows.h"

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
            // With few coefficients more bits of each gain nothing.
            if (!knobs.fixed.coefficients && m < texels && (bits == 8 || m >= kLeastOf16Bits)) {
                encodings.push_back({m, bits});
            }
        }
        encodings.push_back(
            {knobs.fixed.coefficients ? knobs.coefficients : kAllCoefficients, bits});
    }
    // By the bytes they take, about: an index of two and one or two for each of three bands.
    const auto bytes = [texels](const Encoding& e) {
        return std::min(e.coefficients, texels) * (e.code_bits == 8 ? 5 : 8);
    };
    std::stable_sort(encodings.begin(), encodings.end(),
                     [&](const Encoding& a, const Encoding& b) { return bytes(a) < bytes(b); });
    return encodings;
}

OpaquePairs measure_opaque(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                           const Knobs& knobs, std::span<const TestLight> lights,
                           const Context& context) {
    std::vector<PilotReceiver> opaque;
    std::copy_if(receivers.begin(), receivers.end(), std::back_inserter(opaque),
                 [&](const PilotReceiver& r) { return !pilot.layouts[r.material].translucent; });
    OpaquePairs measured{list_encodings(knobs), {}};
    if (std::find(measured.encodings.begin(), measured.encodings.end(), kUnencoded) ==
        measured.encodings.end()) {
        measured.encodings.push_back(kUnencoded);
    }
    measured.pairs = measure_rows(pilot, opaque, {}, {}, {}, knobs.cubemap_size, measured.encodings,
                                  lights, context);
    return measured;
}

double find_direct_floor(const OpaquePairs& opaque, std::span<const PilotReceiver> receivers) {
    double reference = 0;
    for (const PilotReceiver& r : receivers) {
        for (std::size_t l = 0; l < r.truth.first.size(); ++l) {
            reference += r.truth.first[l] * r.truth.second[l];
        }
    }
    double square = 0;
    for (const CheckedPair& p : opaque.of(kUnencoded)) {
        square += p.error[0] * p.error[1];
    }
    return reference > 0 ? std::sqrt(std::max(0.0, square / reference)) : 0.0;
}

std::vector<CheckedPair> insert_opaque(const PilotScene& pilot,
                                       std::span<const PilotReceiver> receivers,
                                       std::span<const CheckedPair> in_media,
                                       const OpaquePairs& opaque, const Encoding& encoding,
                                       std::size_t lights) {
    std::span<const CheckedPair> others = opaque.of(encoding);
    std::vector<CheckedPair> pairs;
    for (const PilotReceiver& r : receivers) {
        std::span<const CheckedPair>& from =
            pilot.layouts[r.material].translucent ? in_media : others;
        if (from.size() < lights) {
            break;  // cancelled
        }
        pairs.insert(pairs.end(), from.begin(), from.begin() + static_cast<std::ptrdiff_t>(lights));
        from = from.subspan(lights);
    }
    return pairs;
}

}  // namespace opaline::bake
