#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/effects/multiple/walks/view_set.h"
#include "bake/effects/multiple/walks/walk_space.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// A place where light that a receiver sees may have been scattered last.
struct FlightNode {
    glm::vec3 position{0};   ///< [m], inside
    glm::vec3 direction{0};  ///< unit, of the flight, away from the eye
    /// Share of such places in the light of its view, for each group of bands.
    std::array<float, 3> weight{};
    std::uint32_t view = 0;  ///< index into ViewSet::into
};

/// Places of a receiver's last scatterings: quadrature over views and depths. The sum of a view's
/// weights is 1 less what crosses the body unscattered or meets another material.
using FirstFlight = std::vector<FlightNode>;

/// First flights of walks from a receiver, as follow_walk draws them in the space's first medium,
/// with their reflections inside. Through a hole of the mesh a flight goes on to the space's box;
/// the other flights are scaled up to replace the light that is lost there. Light that leaves the
/// body unscattered through a triangle of the point's own vertex counts as bright as the rest of
/// its view, as `transmission` leaves it out; `fills_crossed`: so does all light that leaves
/// unscattered. Light from another material does not.
FirstFlight trace_first_flight(const WalkSpace& space, const ViewSet& views, const BodyPoint& point,
                               bool fills_crossed = false);

}  // namespace opaline::bake
