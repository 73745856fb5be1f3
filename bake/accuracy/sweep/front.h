#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace opaline::bake {

/// Cost of a setting (seconds or bytes, > 0) and its relative error (>= 0).
struct CostPoint {
    double cost = 0, error = 0;
};

/// The Pareto front: true for points that no other dominates in cost and error. Equal points are
/// all on the front.
std::vector<bool> pareto_front(std::span<const CostPoint> points);

/// A point's cost over that of the cheapest point whose error is no larger: 1 on the front, else
/// above. Precondition: index < points.size().
double times_the_front(std::span<const CostPoint> points, std::size_t index);

/// Cost at which the front reaches an error: interpolated in log-log between the two neighbours on
/// the front; negative where the front does not reach that far on both sides.
double front_cost_at(std::span<const CostPoint> points, double error);

/// Two points to show side by side, as indices: `better` lies on the front.
struct CostPair {
    std::size_t better = 0, other = 0;
};

/// Of about the same cost (within 25 %) the two whose errors differ most; of about the same error
/// (within 15 %) the two whose costs differ most. Errors from .2 % to 50 %, where a picture shows
/// something. Nothing where no two differ by a fifth.
std::optional<CostPair> equal_cost_pair(std::span<const CostPoint> points);
std::optional<CostPair> equal_error_pair(std::span<const CostPoint> points);

}  // namespace opaline::bake
