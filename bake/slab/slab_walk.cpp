#include "bake/slab/slab_walk.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

struct SlabVector {
    double x = 0, y = 0, z = 0;
};

/// `before` turned by an angle of the cosine given, at the azimuth given around it.
SlabVector turn(const SlabVector& before, double cosine, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, (1 - cosine) * (1 + cosine)));
    const double a = sine * std::cos(azimuth), b = sine * std::sin(azimuth);
    const double level = std::hypot(before.x, before.y);
    constexpr double kUpright = 1e-8;
    if (level < kUpright) {
        return {a, b, std::copysign(cosine, before.z * cosine)};
    }
    const double u = before.x / level, v = before.y / level;
    SlabVector after{cosine * before.x + a * before.z * u - b * v,
                     cosine * before.y + a * before.z * v + b * u, cosine * before.z - a * level};
    const double length = std::sqrt(after.x * after.x + after.y * after.y + after.z * after.z);
    return {after.x / length, after.y / length, after.z / length};
}

/// Sums of weights and of their squares.
struct WeightSum {
    double weight = 0, square = 0;

    void add(double w) {
        weight += w;
        square += w * w;
    }
    void add(const WeightSum& other) {
        weight += other.weight;
        square += other.square;
    }
    SlabEstimate mean(std::uint64_t photons) const {
        const auto n = static_cast<double>(photons);
        if (photons == 0) {
            return {};
        }
        const double share = weight / n;
        const double variance = std::max(0.0, square / n - share * share);
        return {share, std::sqrt(variance / std::max(1.0, n - 1))};
    }
};

/// One side of the slab: what leaves it, by order and by direction.
struct SlabSide {
    WeightSum all;
    std::vector<WeightSum> order, histogram;
};

struct SlabTally {
    SlabSide reflected, transmitted;
    WeightSum lost;  ///< absorbed: 1 less the weight that leaves
};

void add_side(SlabSide& sum, const SlabSide& part) {
    sum.all.add(part.all);
    for (std::size_t i = 0; i < sum.order.size(); ++i) {
        sum.order[i].add(part.order[i]);
    }
    for (std::size_t i = 0; i < sum.histogram.size(); ++i) {
        sum.histogram[i].add(part.histogram[i]);
    }
}

SlabTally empty_tally(const SlabWalkRequest& request) {
    SlabTally tally;
    for (SlabSide* side : {&tally.reflected, &tally.transmitted}) {
        side->order.resize(request.orders);
        side->histogram.resize(std::size_t{request.cosine_bins} * request.azimuth_bins);
    }
    return tally;
}

unsigned bin_of(double fraction, unsigned bins) {
    return std::min(bins - 1, static_cast<unsigned>(fraction * bins));
}

void leave(SlabSide& side, const SlabWalkRequest& request, const SlabVector& direction,
           std::uint32_t order, double weight) {
    side.all.add(weight);
    side.order[std::min(order, request.orders - 1)].add(weight);
    if (side.histogram.empty() || order < request.histogram_from) {
        return;
    }
    const unsigned row = bin_of(std::abs(direction.z), request.cosine_bins);
    const double azimuth = std::abs(std::atan2(direction.y, direction.x)) / pi;
    side.histogram[row * std::size_t{request.azimuth_bins} + bin_of(azimuth, request.azimuth_bins)]
        .add(weight);
}

void walk_photon(const CosineSampler& phase, const SlabWalkRequest& request, std::uint64_t photon,
                 SlabTally& tally) {
    constexpr double kRouletteBelow = 1e-4, kSurvival = 0.1;
    constexpr std::uint32_t kRoulette = 1u << 31;  // of the counter: numbers of their own
    SlabVector direction{std::sqrt((1 - request.cosine) * (1 + request.cosine)), 0, request.cosine};
    double depth = 0, weight = 1;
    for (std::uint32_t event = 0;; ++event) {
        const auto uniform =
            random_uniform(request.seed, RandomStage::slab_walk, photon, event % kRoulette);
        // Two of them, so that short flights are not all of one length; below 1.
        const double flight = -std::log1p(
            -(static_cast<double>(uniform[0]) + static_cast<double>(uniform[1]) * 0x1p-24));
        depth += flight * direction.z;
        const bool reflected = depth < 0;
        if (reflected || depth > request.optical_depth) {
            leave(reflected ? tally.reflected : tally.transmitted, request, direction, event,
                  weight);
            break;
        }
        weight *= request.albedo;
        if (weight < kRouletteBelow) {
            const auto chance = random_uniform(request.seed, RandomStage::slab_walk, photon,
                                               event % kRoulette + kRoulette);
            if (weight == 0 || static_cast<double>(chance[0]) >= kSurvival) {
                weight = 0;
                break;
            }
            weight /= kSurvival;
        }
        direction = turn(direction, phase.sample(static_cast<double>(uniform[2])),
                         2 * pi * static_cast<double>(uniform[3]));
    }
    tally.lost.add(1 - weight);
}

std::vector<SlabEstimate> means(const std::vector<WeightSum>& sums, std::uint64_t photons) {
    std::vector<SlabEstimate> estimates;
    estimates.reserve(sums.size());
    for (const WeightSum& sum : sums) {
        estimates.push_back(sum.mean(photons));
    }
    return estimates;
}

}  // namespace

SlabWalk walk_slab(const CosineSampler& phase, const SlabWalkRequest& request,
                   const Context& context) {
    constexpr std::size_t kBlock = 4096;
    SlabTally sum = empty_tally(request);
    SlabWalk walk;
    for_each_block_in_order(
        request.photons, kBlock, context,
        [&](Range range) {
            SlabTally tally = empty_tally(request);
            for (std::size_t photon = range.begin; photon < range.end; ++photon) {
                walk_photon(phase, request, photon, tally);
            }
            return tally;
        },
        [&](Range range, const SlabTally& tally) {
            add_side(sum.reflected, tally.reflected);
            add_side(sum.transmitted, tally.transmitted);
            sum.lost.add(tally.lost);
            walk.photons += range.end - range.begin;
        });
    walk.reflectance = sum.reflected.all.mean(walk.photons);
    walk.transmittance = sum.transmitted.all.mean(walk.photons);
    walk.absorptance = sum.lost.mean(walk.photons);
    walk.reflected_order = means(sum.reflected.order, walk.photons);
    walk.transmitted_order = means(sum.transmitted.order, walk.photons);
    walk.reflected_histogram = means(sum.reflected.histogram, walk.photons);
    walk.transmitted_histogram = means(sum.transmitted.histogram, walk.photons);
    return walk;
}

}  // namespace opaline::bake
