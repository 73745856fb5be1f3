#include "bake/accuracy/sweep/front.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

bool beats(const CostPoint& a, const CostPoint& b) {
    return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

// Range of errors in which a picture shows a difference.
bool is_visible(const CostPoint& p) {
    return p.error >= 2e-3 && p.error <= 0.5;
}

bool within(double a, double b, double factor) {
    return a > 0 && b > 0 && std::max(a, b) <= factor * std::min(a, b);
}

// The pair, `alike` in one thing, whose other thing differs most; `ratio` > 1 counts.
template <class Alike, class Ratio>
std::optional<CostPair> widest_pair(std::span<const CostPoint> points, Alike&& alike,
                                    Ratio&& ratio) {
    constexpr double kWorthShowing = 1.2;
    const std::vector<bool> front = pareto_front(points);
    std::optional<CostPair> widest;
    double most = kWorthShowing;
    for (std::size_t a = 0; a < points.size(); ++a) {
        for (std::size_t b = 0; front[a] && b < points.size(); ++b) {
            if (a != b && is_visible(points[a]) && is_visible(points[b]) &&
                alike(points[a], points[b]) && ratio(points[a], points[b]) > most) {
                most = ratio(points[a], points[b]);
                widest = CostPair{a, b};
            }
        }
    }
    return widest;
}

}  // namespace

std::vector<bool> pareto_front(std::span<const CostPoint> points) {
    std::vector<bool> front(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        front[i] = std::none_of(points.begin(), points.end(),
                                [&](const CostPoint& other) { return beats(other, points[i]); });
    }
    return front;
}

double times_the_front(std::span<const CostPoint> points, std::size_t index) {
    double cheapest = points[index].cost;
    for (const CostPoint& p : points) {
        if (p.error <= points[index].error) {
            cheapest = std::min(cheapest, p.cost);
        }
    }
    return cheapest > 0 ? points[index].cost / cheapest : 1.0;
}

double front_cost_at(std::span<const CostPoint> points, double error) {
    const std::vector<bool> front = pareto_front(points);
    const CostPoint* above = nullptr;  // the most accurate one that errs more
    const CostPoint* below = nullptr;  // the least accurate one that does not
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!front[i] || points[i].error <= 0) {
            continue;
        }
        if (points[i].error > error) {
            above = above == nullptr || points[i].error < above->error ? &points[i] : above;
        } else {
            below = below == nullptr || points[i].error > below->error ? &points[i] : below;
        }
    }
    if (below == nullptr || (above == nullptr && below->error < error)) {
        return -1;
    }
    if (below->error == error) {
        return below->cost;
    }
    const double share = std::log(error / above->error) / std::log(below->error / above->error);
    return above->cost * std::pow(below->cost / above->cost, share);
}

std::optional<CostPair> equal_cost_pair(std::span<const CostPoint> points) {
    return widest_pair(
        points, [](const CostPoint& a, const CostPoint& b) { return within(a.cost, b.cost, 1.25); },
        [](const CostPoint& a, const CostPoint& b) { return b.error / a.error; });
}

std::optional<CostPair> equal_error_pair(std::span<const CostPoint> points) {
    return widest_pair(
        points,
        [](const CostPoint& a, const CostPoint& b) { return within(a.error, b.error, 1.15); },
        [](const CostPoint& a, const CostPoint& b) { return b.cost / a.cost; });
}

}  // namespace opaline::bake
