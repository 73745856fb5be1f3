#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/multiple/walks/sparse_vectors.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/ray_scene.h"

namespace opaline::bake {

struct OtherLight;  // exchange/other_light.h

/// Light that enters a medium through its surface samples, E(x, w) = Ft(eta, n.w) V(x, w) max(0,
/// n.w) ([Wang2005] eq. (8)): the same for all bands. Other light enters as diffuse light does.
struct SampleTransport {
    SparseVectors rows;       ///< Haar vectors of A_i E_i, truncated [m^2]
    std::vector<float> mean;  ///< mean of E over the sphere, before truncation
    std::vector<float> norm;  ///< ||E||, before truncation, with other light
    /// Of A_i E_i of SampleOptions::light, times the mean of Ft over diffuse light; none without.
    SparseVectors other;
    std::uint64_t rays = 0;
};

struct SampleOptions {
    std::uint32_t cubemap_size = 32;
    std::uint32_t kept = 128;  ///< entries per vector
    double eta = 1;
    bool share_rays = true;             ///< between the samples of a group (kd_order.h)
    const OtherLight* light = nullptr;  ///< besides, or instead of, that of the environment
    std::uint32_t kept_of_light = 32;   ///< entries of each vector of SampleTransport::other
};

/// Without the environment (OtherLight::environment) `rows` have no entries, and
/// vectors of other light keep all of theirs that are not 0. Stops early, with fewer samples, if
/// the context is cancelled.
SampleTransport bake_sample_transport(const RayScene& rays, std::span<const SurfaceSample> samples,
                                      const SampleOptions& options, const Context& context);

}  // namespace opaline::bake
