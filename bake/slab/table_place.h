#pragma once

#include <algorithm>
#include <cstddef>

namespace opaline::bake {

/// Between two of the nodes of an axis: the first, and the share of the second.
struct TablePlace {
    std::size_t first = 0;
    double share = 0;
};

/// `fraction` of an axis of `count` >= 2 even nodes; past an end, that end.
inline TablePlace place_at(double fraction, std::size_t count) {
    const double at = std::clamp(fraction, 0.0, 1.0) * static_cast<double>(count - 1);
    const std::size_t first = std::min(static_cast<std::size_t>(at), count - 2);
    return {first, at - static_cast<double>(first)};
}

/// Even in depth / (1 + depth), so that the last node is an infinite depth.
inline TablePlace place_depth(double depth, std::size_t count) {
    return place_at(1 - 1 / (1 + depth), count);
}
inline double depth_of_node(std::size_t node, std::size_t count, double most) {
    const double left = static_cast<double>(count - 1 - node);
    return left > 0 ? std::min(static_cast<double>(node) / left, most) : most;
}

}  // namespace opaline::bake
