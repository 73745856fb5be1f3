#include "bake/scattering/half_space_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/scattering/fresnel.h"

namespace opaline::bake {
namespace {

// Cosine to the depth axis after a scattering event; the azimuth `v` is uniform.
double scatter(double mu, double g, double u, double v) {
    double cosine = 2 * u - 1;
    if (std::abs(g) > 1e-3) {
        const double f = (1 - g * g) / (1 + g * cosine);
        cosine = (1 + g * g - f * f) / (2 * g);
    }
    cosine = std::clamp(cosine, -1.0, 1.0);
    const double sines = std::sqrt(std::max(0.0, (1 - cosine * cosine) * (1 - mu * mu)));
    return std::clamp(mu * cosine + sines * std::cos(2 * std::numbers::pi * v), -1.0, 1.0);
}

SlabShares walk(double albedo, double g, double eta, double thickness, std::uint32_t path,
                std::uint64_t seed) {
    std::uint32_t event = 0;
    const auto random = [&] {
        return random_uniform(seed, RandomStage::half_space_walk, path, event++);
    };
    // Uniform radiance arrives with a cosine-weighted angle.
    const double outside = std::sqrt(double{random()[0]});
    double weight = fresnel_transmittance(outside, eta);
    double mu = refracted_cosine(outside, eta);  // > 0: down
    double depth = 0;                            // in mean free paths
    unsigned scatterings = 0;
    bool reflected = false;
    SlabShares found;
    constexpr unsigned kMostEvents = 100000;
    while (weight > 0 && event < kMostEvents) {
        const std::array<float, 4> u = random();
        depth -= std::log1p(-double{u[0]}) * mu;
        if (depth <= 0) {
            if (mu >= 0) {
                return found;  // horizontal within rounding
            }
            const double leaves = fresnel_transmittance(-mu, 1 / eta);
            (scatterings == 0                 ? found.straight
             : scatterings == 1 && !reflected ? found.once
                                              : found.rest) += weight * leaves;
            weight *= 1 - leaves;
            depth = 0;
            mu = -mu;
            reflected = true;
            continue;  // free flight has no memory
        }
        if (depth >= thickness) {
            const double leaves = fresnel_transmittance(mu, 1 / eta);
            (scatterings == 0 ? found.straight : found.through) += weight * leaves;
            weight *= 1 - leaves;
            depth = thickness;
            mu = -mu;
            reflected = true;
            continue;
        }
        weight *= albedo;
        ++scatterings;
        if (weight < 0.05) {
            // Russian roulette.
            if (double{u[3]} >= 0.25) {
                return found;
            }
            weight *= 4;
        }
        mu = scatter(mu, g, double{u[1]}, double{u[2]});
    }
    return found;
}

void add(SlabShares& sum, const SlabShares& part) {
    sum.once += part.once;
    sum.rest += part.rest;
    sum.through += part.through;
    sum.straight += part.straight;
}

}  // namespace

HalfSpaceReflectance walk_half_space(double albedo, double g, double eta, std::uint32_t paths,
                                     std::uint64_t seed, const Context& context) {
    return walk_slab(albedo, g, eta, std::numeric_limits<double>::infinity(), paths, seed, context);
}

SlabShares walk_slab(double albedo, double g, double eta, double thickness, std::uint32_t paths,
                     std::uint64_t seed, const Context& context) {
    SlabShares sum;
    for_each_block_in_order(
        paths, 2048, context,
        [&](Range range) {
            SlabShares part;
            for (std::size_t path = range.begin; path < range.end; ++path) {
                add(part, walk(albedo, g, eta, thickness, static_cast<std::uint32_t>(path), seed));
            }
            return part;
        },
        [&](Range, const SlabShares& part) { add(sum, part); });
    for (double* share : {&sum.once, &sum.rest, &sum.through, &sum.straight}) {
        *share /= paths;
    }
    return sum;
}

}  // namespace opaline::bake
