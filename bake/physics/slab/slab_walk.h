#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"

namespace opaline::bake {

/// Draws the cosine between the directions before and after a scattering.
class CosineSampler {
  public:
    /// [Henyey1941]; |g| < 1.
    static CosineSampler henyey_greenstein(double g);
    /// A density linear in the cosine between the rows, of any scale: cosines ascend within [-1,
    /// 1], values are >= 0 and not all of them 0.
    static CosineSampler tabulated(std::span<const double> cosine, std::span<const double> value);

    /// In [-1, 1]; ascends with `uniform`, in [0, 1).
    double sample(double uniform) const;

  private:
    double sample_table(double uniform) const;

    double g_ = 0;
    std::vector<double> cosine_, value_, cumulative_;  ///< a table, of integral 1
};

/// A slab in a beam, and how it is to be simulated.
struct SlabWalkRequest {
    double optical_depth = 1;  ///< along the normal, >= 0; time grows with it
    double albedo = 1;         ///< in [0, 1]
    double cosine = 1;         ///< of incidence, in (0, 1]
    std::uint64_t photons = 1000000, seed = 0;
    unsigned orders = 4;  ///< kept apart: 0 to `orders` - 1; the last of them takes all that follow
    /// Directions in which light leaves that was scattered `histogram_from` times or more: even
    /// bins of the cosine to the normal, times even bins of the azimuth's absolute value from 0,
    /// where the beam goes, to pi. None if either number is 0.
    unsigned histogram_from = 0, cosine_bins = 0, azimuth_bins = 0;
    double eta = 1;  ///< index of the slab over that of both sides, as SlabRequest::eta
};

/// Share of the incident flux and one standard deviation of it.
struct SlabEstimate {
    double share = 0, standard_error = 0;
};

struct SlabWalk {
    std::uint64_t photons = 0;  ///< fewer than asked for if it was cancelled
    SlabEstimate reflectance, transmittance, absorptance;
    std::vector<SlabEstimate> reflected_order, transmitted_order;  ///< [order]
    /// [cosine bin * azimuth bins + azimuth bin], in shares of the flux
    std::vector<SlabEstimate> reflected_histogram, transmitted_histogram;
};

/// Photons through a plane slab, one path at a time, with survival weights and Russian roulette
/// below 1e-4. Shares nothing with `solve_slab`, as a check of it. Random numbers are a function of
/// seed, photon and event alone: the result has the same bits for any number of threads.
SlabWalk walk_slab(const CosineSampler& phase, const SlabWalkRequest& request,
                   const Context& context);

}  // namespace opaline::bake
