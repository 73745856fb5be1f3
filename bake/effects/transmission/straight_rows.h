#pragma once

#include <cstdint>

#include "bake/effects/transmission/straight_paths.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/lamp_bounces.h"
#include "bake/plan/dense_rows.h"
#include "bake/plan/row_layout.h"

namespace opaline::bake {

/// Cosine of the radius of the disc of directions over which the light of an exit is spread, for
/// `views` of a receiver: the discs of all views together cover a hemisphere.
double spread_cosine(double views);

/// Harmonics of the view that a subject's rows hold light in that crosses it: 1, 4 or 9.
std::uint32_t straight_terms(const RowLayout& layout);

/// So many times the views of a receiver are followed where these show more than a little.
inline constexpr std::uint32_t kFinerViews = 4;

/// Adds light that crosses the body straight to the rows of a receiver (README.md, "Rows"), from
/// `views` of it or kFinerViews times as many. `surfaces`: what surfaces send that stand before the
/// sky; null: they are black. Any thread; returns the rays traced.
std::uint64_t add_straight(const StraightBody& body, const BodyPoint& point, std::uint32_t views,
                           const RowLayout& layout, const DenseRow& row,
                           const BounceLight* surfaces = nullptr);

/// The same of light of lamps, and of surfaces that these light, around and inside the body: column
/// e of each row is lamp e.
std::uint64_t add_straight_lamps(const StraightBody& body, const BodyPoint& point,
                                 std::uint32_t views, const RowLayout& layout, const DenseRow& row,
                                 const LampBounces& lamps);

/// The surfaces from which light crosses the body straight to a point, by `views` of it, as of
/// EffectDescriptor::look_through. Counts `rays`.
CrossingViews look_through(const StraightBody& body, const BodyPoint& point, std::uint32_t views,
                           std::uint64_t& rays);

}  // namespace opaline::bake
