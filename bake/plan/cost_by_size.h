#pragma once

#include <algorithm>
#include <cmath>

namespace opaline::bake {

/// Seconds of one thread per unit of work as a function of the number of triangles: two values,
/// linear in log2 of the number (the depth of the hierarchy) between and beyond them.
struct CostBySize {
    static constexpr double kFew = 3072, kMany = 49152;  ///< triangles of the two values
    double few = 0, many = 0;

    /// `triangles` >= 0. Never less than a fraction of `few`, because a mesh of one triangle has a
    /// cost too.
    double at(double triangles) const {
        constexpr double kLeastShare = 0.25;
        const double place = std::log2(std::max(triangles, 1.0) / kFew) / std::log2(kMany / kFew);
        return std::max(few + place * (std::max(many, few) - few), kLeastShare * few);
    }
};

}  // namespace opaline::bake
