#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "bake/receivers/linear_fit.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// A point where light from other surfaces was gathered.
struct GatherSite {
    Receiver at;
    /// [m], (mean of 1 / t^2)^-1/2 over cosine-distributed rays of lengths t; infinite where none
    /// ended. What a linear function errs by at a distance r goes with the second derivative of
    /// irradiance, so with (r / clearance)^2, as what is near fills it [Ward1992].
    float clearance = 0;
};

/// The irradiance between points where it is known: a linear fit to those around
/// (`fit_near_sites`). So light needs rays only as densely as it changes, and the noise of sites
/// averages out.
class GatherSites {
  public:
    GatherSites();
    explicit GatherSites(std::vector<GatherSite> sites);
    GatherSites(GatherSites&&) noexcept;
    GatherSites& operator=(GatherSites&&) noexcept;
    ~GatherSites();

    /// Weights of the sites near a point, of sum 1. False, and none, where these say too little of
    /// it: they are few, because others face another way or are no nearer than other surfaces;
    /// or the fit would have more than `most_noise` of the variance of a site. Overwrites
    /// `weights`.
    bool weigh(const Receiver& at, float most_noise, std::vector<SiteWeight>& weights) const;

  private:
    struct Tree;
    std::vector<GatherSite> sites_;
    std::unique_ptr<const Tree> tree_;
};

}  // namespace opaline::bake
