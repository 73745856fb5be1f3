#include "bake/lab/sweep/reference_ladder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/lights/builtin_environment.h"
#include "bake/reference/reference_receivers.h"
#include "bake/scene/orient_bodies.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kReceivers = 256, kFewestReceivers = 16;
constexpr std::uint32_t kFewest = 4, kStep = 4, kTruth = 2;
// Large lights: paths inside a refracting body hardly ever hit a sun.
constexpr const char* kLight = "studio";

// Of how many receivers there is time for the first two rungs and their truth, given what the first
// rung of the fewest took: walks in clear, dense media are long.
std::uint32_t count_affordable(double few_seconds, double seconds) {
    const double each = few_seconds * kStep * (1 + kTruth) / kFewestReceivers;
    return each * kReceivers <= seconds
               ? kReceivers
               : std::max(kFewestReceivers, static_cast<std::uint32_t>(seconds / each));
}

}  // namespace

ReferenceRung compare_rung(const std::vector<Moments>& rung, const std::vector<Moments>& truth) {
    double difference = 0, variance = 0, square = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const double noise = truth[i].variance_of_mean().x;
        const double d = rung[i].mean.x - truth[i].mean.x;
        difference += d * d - noise;
        variance += rung[i].variance_of_mean().x;
        square += truth[i].mean.x * truth[i].mean.x - noise;
    }
    ReferenceRung found;
    if (square > 0) {
        found.error = std::sqrt(std::max(0.0, difference) / square);
        found.stated = std::sqrt(variance / square);
    }
    return found;
}

formats::Result<std::optional<ReferenceLadder>> climb_reference(
    const formats::Scene& given, const ReferenceLadderOptions& options, const Context& context) {
    const OrientedBodies bodies = orient_bodies(given);
    auto scene = make_reference_scene(bodies.scene ? *bodies.scene : given, context.threads);
    if (!scene) return std::move(scene).error();
    const auto light = make_environment(kLight);
    if (!light) return light.error();
    const LightSampler sampler = make_light_sampler(*light, glm::mat3(1.0f));
    const PathSpace space{*scene, sampler, {}};
    EstimateOptions wanted;
    wanted.seed = options.seed;
    wanted.samples = kFewest;
    const auto few = estimate_luminance(
        space, choose_receivers(*scene, kFewestReceivers, options.seed, std::nullopt), wanted,
        context);
    if (!few) return few.error();
    if (few->seconds * kStep * (1 + kTruth) > options.most_seconds) {
        return std::optional<ReferenceLadder>();
    }
    const auto receivers = choose_receivers(*scene, count_affordable(few->seconds, options.seconds),
                                            options.seed, std::nullopt);

    ReferenceLadder ladder{kLight, static_cast<std::uint32_t>(receivers.size()), 0, {}};
    std::vector<std::vector<Moments>> climbed;
    std::vector<Moments> moments(receivers.size());
    double seconds = 0;
    // The next rung takes kStep times as long as all so far, its truth kTruth times that.
    for (std::uint32_t samples = kFewest;
         samples <= options.most_samples &&
         (climbed.size() < 2 || kStep * (1 + kTruth) * seconds <= options.seconds);
         samples *= kStep) {
        wanted.samples = samples - wanted.first;
        const auto estimate = estimate_luminance(space, receivers, wanted, context);
        if (!estimate) return estimate.error();
        for (std::size_t i = 0; i < moments.size(); ++i) {
            moments[i].merge(estimate->pixel[i]);
        }
        seconds += estimate->seconds;
        ladder.rungs.push_back({samples, seconds});
        climbed.push_back(moments);
        wanted.first = samples;
    }
    wanted.samples = ladder.truth_samples = kTruth * wanted.first;
    const auto truth = estimate_luminance(space, receivers, wanted, context);
    if (!truth) return truth.error();
    for (std::size_t r = 0; r < climbed.size(); ++r) {
        const ReferenceRung found = compare_rung(climbed[r], truth->pixel);
        if (found.stated == 0) return std::optional<ReferenceLadder>();
        ladder.rungs[r].error = found.error;
        ladder.rungs[r].stated = found.stated;
    }
    return std::optional(std::move(ladder));
}

}  // namespace opaline::bake
