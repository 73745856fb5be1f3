#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace opaline::bake {

/// A site's share of the row of a receiver.
struct SiteWeight {
    std::uint32_t site = 0;
    float weight = 0;
};

/// A site near a point.
struct NearSite {
    std::uint32_t site = 0;
    double kernel = 0;    ///< > 0, what it counts
    glm::vec3 offset{0};  ///< from the point, in widths of the kernel
    glm::vec3 normal{0};  ///< unit
    float tint = 0;       ///< what rows depend on besides, less that of the point
};

/// Appends the weights that make of rows of sites the constant of the linear function of position
/// and normal that fits them best, [Loader1999]; their sum is 1. A site's place: 1, two offsets,
/// two coordinates of its normal in the frame of the point's, the cosine between both less 1, which
/// tells the crest of a ridge from its flanks; and the tint, if there are some. Some weights may be
/// negative. `normal`: the point's, unit.
void fit_near_sites(std::span<const NearSite> sites, glm::vec3 normal, bool has_tints,
                    std::vector<SiteWeight>& weights);

}  // namespace opaline::bake
