#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/multiple/walks/first_flight.h"
#include "bake/effects/multiple/walks/walk.h"
#include "bake/receivers/point_grid.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Starts of walks at first scatterings inside the body: one below each site of the surface, its
/// direction that of uniform light that enters, its depth that of a first collision before the
/// next surface. Directions and depths are spread evenly over neighbouring sites (a rank-1
/// lattice); `sites` are in kd-order. Incomplete if the context is cancelled.
std::vector<WalkStart> make_inner_starts(const WalkSpace& space,
                                         std::span<const SurfaceSample> sites,
                                         const Context& context);

/// A site's share of the rows of a receiver, for each group of bands.
struct InnerWeight {
    std::uint32_t site = 0;
    std::array<std::array<float, 3>, 1 + kAllDegrees> row{};
};

/// Rows between sites inside a body (README.md, "From sites to receivers"): light scattered at a
/// place is a quadratic function of the place, fitted to the sites around, and the row of a
/// receiver is the mean of that function over the receiver's own first flight. In media with a mean
/// cosine it is also linear in the direction of the flight.
class InnerField {
  public:
    InnerField() : InnerField({}, 1, 1, true) {}
    /// Of walks that begin with a scattering. `radius` [m] > 0 of the fit; `path` [m] > 0, over
    /// which light inside varies: the transport mean free path.
    InnerField(std::span<const WalkStart> starts, float radius, float path, bool is_isotropic);

    bool empty() const { return position_.empty(); }
    std::size_t size() const { return position_.size(); }

    /// Weights of sites for the first `rows` rows of `views`, 1, 4 or 9. Their sum is the share of
    /// light that the flight scatters, in each row. Only sites visible from the point count, unless
    /// they are too few. Overwrites `weights`; none where nothing is scattered or there is no site.
    void weigh(const WalkSpace& space, const BodyPoint& point, const ViewSet& views,
               const FirstFlight& flight, std::uint32_t rows,
               std::vector<InnerWeight>& weights) const;

  private:
    struct Neighbour {
        std::uint32_t site;
        double kernel;
    };
    struct Centre {
        glm::vec3 position{0}, direction{0};
    };
    /// Functions that are fitted: 1, place, direction, squares of the place.
    static constexpr std::size_t kMostFunctions = 13;
    using Functions = std::array<double, kMostFunctions>;

    std::vector<Neighbour> collect(const WalkSpace& space, const BodyPoint& point,
                                   const Centre& centre) const;
    std::vector<Neighbour> nearest(const Centre& centre) const;
    Functions eval(const Centre& centre, glm::vec3 position, glm::vec3 direction) const;
    std::size_t count_functions(std::size_t sites) const;
    float depth_below(glm::vec3 position, glm::vec3 normal) const;

    std::vector<glm::vec3> position_, arrival_;
    std::vector<float> depth_;
    glm::vec3 low_{std::numeric_limits<float>::max()}, high_{-std::numeric_limits<float>::max()};
    float radius_ = 1, path_ = 1;
    bool is_isotropic_ = true;
    PointGrid grid_;
};

}  // namespace opaline::bake
