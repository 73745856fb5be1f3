#include "bake/physics/slab/slab_walk.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/physics/fresnel.h"

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
    if (side.histogram.empty() || order < request.histogram_from) return;
    const unsigned row = bin_of(std::abs(direction.z), request.cosine_bins);
    const double azimuth = std::abs(std::atan2(direction.y, direction.x)) / pi;
    side.histogram[row * std::size_t{request.azimuth_bins} + bin_of(azimuth, request.azimuth_bins)]
        .add(weight);
}

/// A photon inside: where it is, and where it flies.
struct SlabPhoton {
    double depth = 0;
    SlabVector direction;
};

/// `direction` on the other side of a boundary; `eta`: index there over that here. Not for total
/// reflection.
SlabVector refract(const SlabVector& direction, double eta) {
    return {direction.x / eta, direction.y / eta,
            std::copysign(refracted_cosine(std::abs(direction.z), eta), direction.z)};
}

/// A flight of the length given between two boundaries that reflect it totally.
void fly_between_mirrors(SlabPhoton& photon, double flight, double optical_depth) {
    const double period = 2 * optical_depth;
    double unfolded = std::fmod(photon.depth + flight * photon.direction.z, period);
    unfolded += unfolded < 0 ? period : 0;
    const bool turned = unfolded > optical_depth;
    photon.depth = turned ? period - unfolded : unfolded;
    // Of every other pass the depth falls as it rose.
    photon.direction.z = turned ? -photon.direction.z : photon.direction.z;
}

/// The flight to the next scattering, true; or out of the slab, false: then photon.direction is
/// outside and photon.depth below 0 or above the slab's. `steps` counts random numbers.
bool fly(SlabPhoton& photon, const SlabWalkRequest& request, std::uint64_t key,
         std::uint32_t& steps) {
    while (true) {
        const auto uniform = random_uniform(request.seed, RandomStage::slab_walk, key, steps++);
        // Two of them, so that short flights are not all of one length; below 1.
        const double flight = -std::log1p(
            -(static_cast<double>(uniform[0]) + static_cast<double>(uniform[1]) * 0x1p-24));
        const double pass =
            request.eta == 1 ? 1
                             : fresnel_transmittance(std::abs(photon.direction.z), 1 / request.eta);
        if (pass == 0) {
            fly_between_mirrors(photon, flight, request.optical_depth);
            return true;
        }
        photon.depth += flight * photon.direction.z;
        if (photon.depth > 0 && photon.depth < request.optical_depth) return true;
        if (static_cast<double>(uniform[2]) < pass) {
            photon.direction = refract(photon.direction, 1 / request.eta);
            return false;
        }
        photon.depth = photon.direction.z < 0 ? 0 : request.optical_depth;
        photon.direction.z = -photon.direction.z;
    }
}

void walk_photon(const CosineSampler& phase, const SlabWalkRequest& request, std::uint64_t key,
                 SlabTally& tally) {
    constexpr double kRouletteBelow = 1e-4, kSurvival = 0.1;
    const SlabVector beam{std::sqrt((1 - request.cosine) * (1 + request.cosine)), 0,
                          request.cosine};
    double weight = 1;
    std::uint32_t steps = 0;
    const auto draw = [&] {
        return random_uniform(request.seed, RandomStage::slab_walk, key, steps++);
    };
    if (request.eta != 1 &&
        static_cast<double>(draw()[0]) < fresnel_reflectance(request.cosine, request.eta)) {
        leave(tally.reflected, request, beam, 0, weight);
        tally.lost.add(0);
        return;
    }
    SlabPhoton photon{0, refract(beam, request.eta)};
    for (std::uint32_t order = 0;; ++order) {
        if (!fly(photon, request, key, steps)) {
            const bool reflected = photon.direction.z < 0;
            leave(reflected ? tally.reflected : tally.transmitted, request, photon.direction, order,
                  weight);
            break;
        }
        const auto uniform = draw();
        weight *= request.albedo;
        if (weight < kRouletteBelow) {
            if (weight == 0 || static_cast<double>(uniform[2]) >= kSurvival) {
                weight = 0;
                break;
            }
            weight /= kSurvival;
        }
        photon.direction = turn(photon.direction, phase.sample(static_cast<double>(uniform[0])),
                                2 * pi * static_cast<double>(uniform[1]));
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

CosineSampler CosineSampler::henyey_greenstein(double g) {
    CosineSampler sampler;
    sampler.g_ = g;
    return sampler;
}

CosineSampler CosineSampler::tabulated(std::span<const double> cosine,
                                       std::span<const double> value) {
    assert(cosine.size() == value.size() && cosine.size() >= 2);
    CosineSampler sampler;
    sampler.cosine_.assign(cosine.begin(), cosine.end());
    sampler.value_.assign(value.begin(), value.end());
    double sum = 0;
    sampler.cumulative_.push_back(0);
    for (std::size_t i = 1; i < cosine.size(); ++i) {
        sum += (cosine[i] - cosine[i - 1]) * (value[i] + value[i - 1]) / 2;
        sampler.cumulative_.push_back(sum);
    }
    assert(sum > 0);
    for (double& x : sampler.value_) {
        x /= sum;
    }
    for (double& x : sampler.cumulative_) {
        x /= sum;
    }
    return sampler;
}

double CosineSampler::sample(double uniform) const {
    if (!cosine_.empty()) return sample_table(uniform);
    const double even = 2 * uniform - 1;
    constexpr double kNearlyIsotropic = 1e-4;  // the closed form cancels there
    if (std::abs(g_) < kNearlyIsotropic) {
        return std::clamp(even + 1.5 * g_ * (1 - even * even), -1.0, 1.0);
    }
    const double ratio = (1 - g_ * g_) / (1 + g_ * even);
    return std::clamp((1 + g_ * g_ - ratio * ratio) / (2 * g_), -1.0, 1.0);
}

double CosineSampler::sample_table(double uniform) const {
    const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, uniform);
    const auto i = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
    // The root of a x + slope x^2 / 2 = rest, in the form that does not cancel.
    const double rest = std::max(0.0, uniform - cumulative_[i]);
    const double width = cosine_[i + 1] - cosine_[i], a = value_[i];
    const double slope = (value_[i + 1] - a) / width;
    const double denominator = a + std::sqrt(std::max(0.0, a * a + 2 * slope * rest));
    const double step = denominator > 0 ? 2 * rest / denominator : 0;
    return cosine_[i] + std::min(step, width);
}

}  // namespace opaline::bake
