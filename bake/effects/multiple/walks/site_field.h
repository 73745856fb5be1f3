#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/receivers/point_grid.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// A site's share of the row of a receiver.
struct SiteWeight {
    std::uint32_t site = 0;
    float weight = 0;
};

/// Rows between sites by local regression (README.md, [Loader1999]): the row of a receiver is the
/// constant of the linear function of position and normal that fits the sites around it best.
class SiteField {
  public:
    SiteField() : SiteField({}, 1) {}
    /// `radius` [m] > 0 of the fit.
    SiteField(std::span<const SurfaceSample> sites, float radius);

    /// Weights of the sites around a point, of sum 1; some may be negative. Sites on the other side
    /// of a thin part, whose normals point against the receiver's, have none, unless there are no
    /// others. Overwrites `weights`; none only if there is no site.
    void weigh(glm::vec3 position, glm::vec3 normal, std::vector<SiteWeight>& weights) const;

    std::size_t size() const { return position_.size(); }
    float radius() const { return radius_; }

  private:
    std::vector<glm::vec3> position_, normal_;
    float radius_ = 1;
    PointGrid grid_;
};

}  // namespace opaline::bake
