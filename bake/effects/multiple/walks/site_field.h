#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/receivers/linear_fit.h"
#include "bake/receivers/point_grid.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Rows between sites by local regression (README.md, [Loader1999]): the row of a receiver is the
/// constant of the linear function of position and normal that fits the sites around it best; in a
/// medium that varies, of its local colour as well, so that rows follow it closer than the radius.
class SiteField {
  public:
    SiteField() : SiteField({}, 1) {}
    /// `radius` [m] > 0 of the fit. `tints`: of each site, how bright the medium is there, in [0,
    /// 1]; none: it is homogeneous.
    SiteField(std::span<const SurfaceSample> sites, float radius, std::vector<float> tints = {});

    /// Weights of the sites around a point, of sum 1; some may be negative. Sites on the other side
    /// of a thin part, whose normals point against the receiver's, have none, unless there are no
    /// others. Overwrites `weights`; none only if there is no site. `tint`: as of sites, at the
    /// point.
    void weigh(glm::vec3 position, glm::vec3 normal, std::vector<SiteWeight>& weights,
               float tint = 1) const;

    std::size_t size() const { return position_.size(); }
    float radius() const { return radius_; }

  private:
    std::vector<NearSite> collect(glm::vec3 position, glm::vec3 normal, float tint,
                                  std::vector<std::uint32_t>& around) const;

    std::vector<glm::vec3> position_, normal_;
    std::vector<float> tint_;
    float radius_ = 1;
    PointGrid grid_;
};

}  // namespace opaline::bake
