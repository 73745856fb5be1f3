#include "bake/effects/volumes/phase_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "bake/physics/phase.h"
#include "formats/opal/phase_table.h"

namespace opaline::bake {
namespace {

using formats::kPhaseEntries;
using formats::phase_cosine;

constexpr std::size_t kParts = 32;  // samples of p within a step between entries

// p between two cosines.
struct PhasePart {
    double place = 0;        // of its middle, among the entries
    double solid_angle = 0;  // [sr]
    double value = 0;        // [1/sr]
};

std::vector<PhasePart> sample_phase(const formats::PhaseFunction& phase) {
    const PhaseDensity density = make_phase_density(phase);
    std::vector<PhasePart> parts((kPhaseEntries - 1) * kParts);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto at = [&](double within) {
            return (static_cast<double>(i) + within) / static_cast<double>(kParts);
        };
        parts[i] = {
            at(0.5),
            2 * std::numbers::pi * (phase_cosine(at(1)) - phase_cosine(at(0))),
            eval_phase(density, phase_cosine(at(0.5))),
        };
    }
    return parts;
}

// The cut at which min(p, cut) integrates to `mass`; the largest value where p is below that.
double find_cut(const std::vector<PhasePart>& parts, double mass) {
    double low = 0, high = 0;
    for (const PhasePart& part : parts) {
        high = std::max(high, part.value);
    }
    // To the last bit: each step halves the interval.
    for (double middle = 0.5 * high; middle > low && middle < high; middle = 0.5 * (low + high)) {
        double sum = 0;
        for (const PhasePart& part : parts) {
            sum += part.solid_angle * std::min(part.value, middle);
        }
        (sum < mass ? low : high) = middle;
    }
    return high;
}

}  // namespace

std::vector<float> tabulate_phase(const formats::PhaseFunction& phase, double peak) {
    const std::vector<PhasePart> parts = sample_phase(phase);
    const double cut = peak > 0 ? find_cut(parts, 1 - peak) : HUGE_VAL;
    std::vector<double> sum(kPhaseEntries), weight(kPhaseEntries);
    for (const PhasePart& part : parts) {
        const auto i = static_cast<std::size_t>(part.place);
        const double upper = part.place - static_cast<double>(i);
        for (const auto& [entry, share] : {std::pair{i, 1 - upper}, std::pair{i + 1, upper}}) {
            sum[entry] += share * part.solid_angle * std::min(part.value, cut);
            weight[entry] += share * part.solid_angle;
        }
    }
    std::vector<float> table(kPhaseEntries);
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i] = static_cast<float>(sum[i] / weight[i]);
    }
    const double integral = formats::integrate_phase_table(table);
    for (float& value : table) {
        value = static_cast<float>(static_cast<double>(value) / integral);
    }
    return table;
}

}  // namespace opaline::bake
