#include "bake/physics/path_differentials/footprint.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace opaline::bake {
namespace {

double cross2(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

glm::dvec2 upper(const glm::dvec2& v) {
    return v.y > 0 || (v.y == 0 && v.x > 0) ? v : -v;
}

/// Those that are not 0, in the upper half plane, by angle.
std::vector<glm::dvec2> sorted_fan(std::span<const glm::dvec2> vectors) {
    std::vector<glm::dvec2> fan;
    fan.reserve(vectors.size());
    for (const glm::dvec2& v : vectors) {
        if (v != glm::dvec2(0)) {
            fan.push_back(upper(v));
        }
    }
    std::sort(fan.begin(), fan.end(),
              [](const glm::dvec2& a, const glm::dvec2& b) { return cross2(a, b) > 0; });
    return fan;
}

}  // namespace

double polygon_area(std::span<const glm::dvec2> vectors) {
    double area = 0;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        for (std::size_t j = i + 1; j < vectors.size(); ++j) {
            area += std::abs(cross2(vectors[i], vectors[j]));
        }
    }
    return area;
}

double pair_area(const FootprintPair& pair) {
    return std::abs(cross2(pair.A, pair.B));
}

FootprintPair best_pair(std::span<const glm::dvec2> vectors) {
    const std::vector<glm::dvec2> fan = sorted_fan(vectors);
    const glm::dvec2 sum = std::accumulate(fan.begin(), fan.end(), glm::dvec2(0));
    FootprintPair best{sum, glm::dvec2(0)};
    double most = 0;
    // A is a run of the fan; the rest, the part before it turned round, is the run that follows.
    glm::dvec2 before(0);
    for (std::size_t i = 0; i < fan.size(); before += fan[i], ++i) {
        glm::dvec2 run(0);
        for (std::size_t j = i; j < fan.size(); ++j) {
            run += fan[j];
            const FootprintPair pair{run, sum - run - 2.0 * before};
            if (pair_area(pair) > most) {
                most = pair_area(pair);
                best = pair;
            }
        }
    }
    return best;
}

FootprintPair polygon_pair(std::span<const glm::dvec2> vectors) {
    const FootprintPair pair = best_pair(vectors);
    const double part = pair_area(pair);
    const double scale = part > 0 ? std::sqrt(polygon_area(vectors) / part) : 1;
    return {scale * pair.A, scale * pair.B};
}

FootprintPair rms_pair(std::span<const glm::dvec2> vectors) {
    double xx = 0, xy = 0, yy = 0;
    for (const glm::dvec2& v : vectors) {
        xx += v.x * v.x;
        xy += v.x * v.y;
        yy += v.y * v.y;
    }
    // Half the angle of (xx - yy, 2 xy). The smaller eigenvalue from the determinant, the sum of
    // squares of cross products: a difference would lose the digits of thin footprints.
    double determinant = 0;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        for (std::size_t j = i + 1; j < vectors.size(); ++j) {
            const double area = cross2(vectors[i], vectors[j]);
            determinant += area * area;
        }
    }
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    const double larger = 0.5 * (xx + yy + std::hypot(xx - yy, 2 * xy));
    const double smaller = larger > 0 ? determinant / larger : 0;
    const glm::dvec2 e(std::cos(angle), std::sin(angle));
    return {std::sqrt(larger) * e, std::sqrt(smaller) * glm::dvec2(-e.y, e.x)};
}

PairExtent pair_extent(const FootprintPair& pair) {
    const double sum = glm::dot(pair.A, pair.A) + glm::dot(pair.B, pair.B);
    const double difference = glm::dot(pair.A, pair.A) - glm::dot(pair.B, pair.B);
    const double major =
        std::sqrt(0.5 * (sum + std::hypot(difference, 2 * glm::dot(pair.A, pair.B))));
    return {major, major > 0 ? pair_area(pair) / major : 0};
}

}  // namespace opaline::bake
