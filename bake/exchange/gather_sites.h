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
    /// ended. The error of a linear fit at a distance r grows with the second derivative of the
    /// irradiance, so with (r / clearance)^2, because near surfaces dominate it [Ward1992].
    float clearance = 0;
};

/// The irradiance between sites: a linear fit to the sites around (`fit_near_sites`). Rays are
/// needed only as densely as the light changes, and the noise of sites averages out.
class GatherSites {
  public:
    GatherSites();
    explicit GatherSites(std::vector<GatherSite> sites);
    GatherSites(GatherSites&&) noexcept;
    GatherSites& operator=(GatherSites&&) noexcept;
    ~GatherSites();

    /// Weights of the sites near a point, of sum 1. False, and none, where these are too few,
    /// because others face another way or are no nearer than other surfaces, or where the variance
    /// of the fit would exceed `most_noise` times that of a site. Overwrites `weights`.
    bool weigh(const Receiver& at, float most_noise, std::vector<SiteWeight>& weights) const;

  private:
    struct Tree;
    std::vector<GatherSite> sites_;
    std::unique_ptr<const Tree> tree_;
};

}  // namespace opaline::bake
