#include "bake/accuracy/model_pairs.h"

#include <algorithm>
#include <cmath>

#include "bake/accuracy/bootstrap.h"
#include "bake/reference/reference_image.h"

namespace opaline::bake {

void MeanSquares::add(const ModelPair& p) {
    difference += p.difference * p.difference - p.variance;
    truth += p.truth * p.truth - p.variance;
    variance += p.variance;
    mean_difference += p.difference;
    mean_truth += p.truth;
    count += 1;
}

double MeanSquares::share_of_truth(double square) const {
    return truth > 0 ? std::sqrt(std::max(0.0, square) / truth) : 0;
}

MeanSquares sum_up(std::span<const ModelPair> pairs) {
    MeanSquares sum;
    for (const ModelPair& p : pairs) {
        sum.add(p);
    }
    return sum;
}

std::array<double, 2> model_interval(std::span<const ModelPair> pairs, std::size_t receivers,
                                     std::uint64_t seed) {
    return bootstrap_interval(receivers, seed, [&](std::span<const std::size_t> drawn) {
        MeanSquares sum;
        for (const std::size_t r : drawn) {
            for (std::size_t at = r; at < pairs.size(); at += receivers) {
                sum.add(pairs[at]);
            }
        }
        return sum.rms_relative();
    });
}

formats::Result<LightCheck> check_light(const PathSpace& space,
                                        std::span<const ReferenceReceiver> receivers,
                                        std::span<const double> baked,
                                        const ModelCheckOptions& options, const Context& context) {
    LightCheck check;
    check.pairs.resize(receivers.size());
    std::vector<Moments> moments(receivers.size());
    std::uint64_t events = 0;
    EstimateOptions wanted;
    wanted.seed = options.seed;
    wanted.samples = 64;
    while (true) {
        wanted.first = check.samples;
        const auto estimate = estimate_luminance(space, receivers, wanted, context);
        if (!estimate) {
            return estimate.error();
        }
        check.samples += wanted.samples;
        events += estimate->events;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            moments[i].merge(estimate->pixel[i]);
            const double truth = moments[i].mean.x;
            check.pairs[i] = {baked[i] - truth, truth, moments[i].variance_of_mean().x};
        }
        const MeanSquares sum = sum_up(check.pairs);
        if (sum.noise() <= std::max(options.noise, options.noise_share * sum.rms_relative())) {
            return check;
        }
        const double done = check.samples;
        const double affordable = done * static_cast<double>(options.max_events) /
                                  static_cast<double>(std::max<std::uint64_t>(events, 1));
        wanted.samples = static_cast<std::uint32_t>(std::clamp(affordable - done, 0.0, done));
        if (wanted.samples < check.samples / 8 + 1) {
            return check;
        }
    }
}

}  // namespace opaline::bake
