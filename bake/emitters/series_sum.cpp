#include "bake/emitters/series_sum.h"

#include <algorithm>
#include <utility>

namespace opaline::bake {
namespace {

// A ratio of two passes above this is taken for it: media are open somewhere.
constexpr double kLargestRatio = 0.95;

// Sums of what changed by lamp; of all where `before` has nothing.
std::vector<glm::dvec3> sum_change(const MediaLight& before, const MediaLight& after,
                                   std::size_t lamps) {
    std::vector<glm::dvec3> sums(lamps, glm::dvec3(0));
    for (std::size_t p = 0; p < after.exitance.size(); ++p) {
        const std::vector<glm::vec3>& values = after.exitance[p];
        const bool has_before = p < before.exitance.size() && !before.exitance[p].empty();
        for (std::size_t i = 0; i < values.size(); ++i) {
            const glm::vec3 from = has_before ? before.exitance[p][i] : glm::vec3(0);
            sums[i / (values.size() / lamps)] += glm::dvec3(glm::abs(values[i] - from));
        }
    }
    return sums;
}

}  // namespace

bool SeriesSum::is_last(const MediaLight& before, MediaLight& after, bool gets_none) {
    std::vector<glm::dvec3> change = sum_change(before, after, lamps_);
    const std::vector<glm::dvec3> all = sum_change({}, after, lamps_);
    bool is_settled = true;
    for (std::size_t e = 0; e < lamps_; ++e) {
        is_settled = is_settled && !glm::any(glm::greaterThan(change[e], least_ * all[e]));
    }
    std::swap(change, last_);  // last_: of this pass; change: of the one before
    if (!is_settled && !gets_none) return false;
    if (change.empty()) return true;
    for (std::size_t p = 0; p < after.exitance.size(); ++p) {
        std::vector<glm::vec3>& values = after.exitance[p];
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::size_t e = i / (values.size() / lamps_);
            for (int b = 0; b < 3; ++b) {
                const double ratio =
                    change[e][b] > 0 ? std::min(last_[e][b] / change[e][b], kLargestRatio) : 0;
                const float more = static_cast<float>(ratio / (1 - ratio)) *
                                   (values[i][b] - before.exitance[p][i][b]);
                values[i][b] = std::max(0.0f, values[i][b] + more);
            }
        }
    }
    return true;
}

}  // namespace opaline::bake
