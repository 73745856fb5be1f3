#include "bake/measure/measure_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/base/rng.h"
#include "bake/measure/bootstrap.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kLeastChecked = 16, kMostChecked = 256, kReceiversPerCheck = 40;

double relative_rms(std::span<const CheckedPair> pairs) {
    double error = 0, reference = 0;
    for (const CheckedPair& p : pairs) {
        error += p.error * p.error;
        reference += p.reference * p.reference;
    }
    return reference > 0 ? std::sqrt(error / reference) : 0.0;
}

// Whole receivers are drawn, since one receiver's lights are not independent.
void bootstrap(std::span<const CheckedPair> pairs, std::size_t lights, std::uint64_t seed,
               double (&interval)[2]) {
    std::vector<CheckedPair> resample;
    const auto ends = bootstrap_interval(
        pairs.size() / lights, seed, [&](std::span<const std::size_t> receivers) {
            resample.clear();
            for (const std::size_t r : receivers) {
                const auto own = pairs.subspan(r * lights, lights);
                resample.insert(resample.end(), own.begin(), own.end());
            }
            return relative_rms(resample);
        });
    std::copy(ends.begin(), ends.end(), interval);
}

}  // namespace

std::vector<std::uint32_t> draw_receivers(std::size_t count, std::uint64_t seed) {
    const std::size_t wanted =
        std::min(count, std::clamp(count / kReceiversPerCheck, kLeastChecked, kMostChecked));
    std::vector<std::uint32_t> drawn;
    // One from each of `wanted` equal runs: spread over all primitives, never twice the same.
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t begin = count * i / wanted, end = count * (i + 1) / wanted;
        const double u =
            static_cast<double>(random_uniform(seed, RandomStage::held_back_receivers, i)[0]);
        drawn.push_back(static_cast<std::uint32_t>(
            begin + static_cast<std::size_t>(u * static_cast<double>(end - begin))));
    }
    return drawn;
}

ErrorReport summarise_checks(std::span<const EffectCheck> checks,
                             std::span<const std::string> lights, std::uint64_t seed) {
    ErrorReport report;
    std::vector<CheckedPair> pairs;
    std::vector<std::pair<std::string, std::vector<CheckedPair>>> by_effect;
    for (const EffectCheck& check : checks) {
        if (check.pairs.empty()) {
            continue;
        }
        pairs.insert(pairs.end(), check.pairs.begin(), check.pairs.end());
        auto same = std::find_if(by_effect.begin(), by_effect.end(),
                                 [&](const auto& effect) { return effect.first == check.effect; });
        if (same == by_effect.end()) {
            same = by_effect.insert(same, {check.effect, {}});
            report.reference +=
                (report.reference.empty() ? "" : "; ") + check.effect + ": " + check.reference;
        }
        same->second.insert(same->second.end(), check.pairs.begin(), check.pairs.end());
    }
    if (pairs.empty()) {
        return report;
    }
    for (const auto& [effect, own] : by_effect) {
        report.by_effect.push_back({effect, relative_rms(own)});
    }
    for (std::size_t l = 0; l < lights.size(); ++l) {
        std::vector<CheckedPair> own;
        for (std::size_t i = l; i < pairs.size(); i += lights.size()) {
            own.push_back(pairs[i]);
        }
        report.by_light.push_back({lights[l], relative_rms(own)});
        report.reference += (l == 0 ? "; luminance under " : ", ") + lights[l];
    }
    report.receivers_checked = static_cast<std::uint32_t>(pairs.size() / lights.size());
    report.rms_relative = relative_rms(pairs);
    bootstrap(pairs, lights.size(), seed, report.ci95);
    double squares = 0;
    std::vector<double> magnitude;
    for (const CheckedPair& p : pairs) {
        squares += p.reference * p.reference;
        magnitude.push_back(std::abs(p.error));
    }
    std::sort(magnitude.begin(), magnitude.end());
    const double rms = std::sqrt(squares / static_cast<double>(pairs.size()));
    if (rms > 0) {
        report.p95_relative =
            magnitude[static_cast<std::size_t>(0.95 * static_cast<double>(magnitude.size() - 1))] /
            rms;
        report.max_relative = magnitude.back() / rms;
    }
    return report;
}

}  // namespace opaline::bake
