#include "bake/measure/measure_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/measure/bootstrap.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kLeastChecked = 32, kMostChecked = 1024, kReceiversPerCheck = 40;
// Few receivers, at the edges of shadows, make most of an error. Chances are e^-2 that of a share
// of 2/n of all receivers none is among n drawn, and resamples cannot hold what was not drawn.
constexpr std::size_t kUnseen = 2;

}  // namespace

double relative_rms(std::span<const CheckedPair> pairs) {
    double error = 0, reference = 0;
    for (const CheckedPair& p : pairs) {
        error += p.error[0] * p.error[1];
        reference += p.reference * p.reference;
    }
    // The noise of the estimates can outweigh an error that is nearly zero.
    return reference > 0 ? std::sqrt(std::max(0.0, error / reference)) : 0.0;
}

namespace {

struct Sums {
    double error = 0, reference = 0;
};

double ratio(const Sums& sums) {
    return sums.reference > 0 ? std::sqrt(std::max(0.0, sums.error / sums.reference)) : 0.0;
}

// Whole receivers are drawn, since one receiver's lights are not independent.
std::vector<Sums> sum_receivers(std::span<const CheckedPair> pairs, std::size_t lights) {
    std::vector<Sums> of_receiver(pairs.size() / lights);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        of_receiver[i / lights].error += pairs[i].error[0] * pairs[i].error[1];
        of_receiver[i / lights].reference += pairs[i].reference * pairs[i].reference;
    }
    return of_receiver;
}

std::array<double, 2> resample(std::span<const Sums> of_receiver, std::uint64_t seed) {
    return bootstrap_interval(of_receiver.size(), seed,
                              [&](std::span<const std::size_t> receivers) {
                                  Sums all;
                                  for (const std::size_t r : receivers) {
                                      all.error += of_receiver[r].error;
                                      all.reference += of_receiver[r].reference;
                                  }
                                  return ratio(all);
                              });
}

}  // namespace

ErrorBounds bound_error(std::span<const CheckedPair> pairs, std::size_t lights,
                        std::uint64_t seed) {
    const std::array<double, 2> ends = resample(sum_receivers(pairs, lights), seed);
    return {relative_rms(pairs), ends[0], ends[1]};
}

ErrorBounds bound_stated_error(std::span<const CheckedPair> pairs, std::size_t lights,
                               std::uint64_t seed) {
    ErrorBounds bounds = bound_error(pairs, lights, seed);
    std::vector<Sums> of_receiver = sum_receivers(pairs, lights);
    const Sums worst = *std::ranges::max_element(of_receiver, {}, &Sums::error);
    of_receiver.insert(of_receiver.end(), kUnseen, worst);
    bounds.highest = std::max(bounds.highest, resample(of_receiver, seed)[1]);
    return bounds;
}

std::vector<std::uint32_t> draw_evenly(std::size_t count, std::size_t wanted, RandomStage stage,
                                       std::uint64_t seed) {
    wanted = std::min(count, wanted);
    std::vector<std::uint32_t> drawn;
    for (std::size_t i = 0; i < wanted; ++i) {
        const std::size_t begin = count * i / wanted, end = count * (i + 1) / wanted;
        const auto u = static_cast<double>(random_uniform(seed, stage, i)[0]);
        drawn.push_back(static_cast<std::uint32_t>(
            begin + static_cast<std::size_t>(u * static_cast<double>(end - begin))));
    }
    return drawn;
}

std::vector<std::uint32_t> draw_receivers(std::size_t count, std::uint64_t seed) {
    return draw_evenly(count, std::clamp(count / kReceiversPerCheck, kLeastChecked, kMostChecked),
                       RandomStage::held_back_receivers, seed);
}

void append_pairs(const Luminance& found, const TwoEstimates& truth,
                  std::vector<CheckedPair>& pairs) {
    for (std::size_t l = 0; l < found.size(); ++l) {
        pairs.push_back({{found[l] - truth.first[l], found[l] - truth.second[l]},
                         0.5 * (truth.first[l] + truth.second[l])});
    }
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
    const ErrorBounds bounds = bound_stated_error(pairs, lights.size(), seed);
    report.rms_relative = bounds.rms;
    report.ci95[0] = bounds.lowest;
    report.ci95[1] = bounds.highest;
    double squares = 0;
    std::vector<double> magnitude;
    for (const CheckedPair& p : pairs) {
        squares += p.reference * p.reference;
        magnitude.push_back(0.5 * std::abs(p.error[0] + p.error[1]));
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
