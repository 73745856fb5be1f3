#include "bake/scene/separate_bodies.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "bake/scene/weld.h"
#include "formats/disjoint_sets.h"

namespace opaline::bake {
namespace {

using SlabPlaces = std::array<float, SeparateBodies::kDirections>;

// Pairs of parts that are compared at most; with more, all is one body.
constexpr std::size_t kMostComparisons = 100000000;

// Along the edges, the diagonals of faces and those of a cube.
SlabPlaces slab_places(const glm::vec3& p) {
    return {p.x,
            p.y,
            p.z,
            p.x + p.y,
            p.x - p.y,
            p.y + p.z,
            p.y - p.z,
            p.z + p.x,
            p.z - p.x,
            p.x + p.y + p.z,
            p.x + p.y - p.z,
            p.x - p.y + p.z,
            p.y + p.z - p.x};
}

bool do_meet(const SeparateBodies::Part& a, const SeparateBodies::Part& b, float error) {
    for (std::size_t k = 0; k < SeparateBodies::kDirections; ++k) {
        if (a.low[k] > b.high[k] + error || b.low[k] > a.high[k] + error) return false;
    }
    return true;
}

// How far a point is outside of the slabs of a part.
float distance_outside(const SeparateBodies::Part& part, const SlabPlaces& at) {
    float most = 0;
    for (std::size_t k = 0; k < at.size(); ++k) {
        most = std::max({most, part.low[k] - at[k], at[k] - part.high[k]});
    }
    return most;
}

}  // namespace

SeparateBodies::SeparateBodies(const formats::Scene& scene, std::uint32_t material) {
    // Triangles as sets of points, of which each has one number.
    std::unordered_map<glm::vec3, std::uint32_t, PositionHash> number;
    std::vector<glm::vec3> position;
    std::vector<std::uint32_t> corners;
    for (const formats::Primitive& primitive : scene.primitives) {
        if (primitive.material != material) continue;
        for (std::size_t i = 0; i < primitive.index.size() / 3 * 3; ++i) {
            const glm::vec3 at = weld_key(primitive.position[primitive.index[i]]);
            const auto [found, is_new] =
                number.try_emplace(at, static_cast<std::uint32_t>(position.size()));
            if (is_new) position.push_back(at);
            corners.push_back(found->second);
        }
    }
    formats::DisjointSets sets(position.size());
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        sets.join(corners[i], corners[i + 1]);
        sets.join(corners[i], corners[i + 2]);
    }
    std::vector<std::uint32_t> part(position.size());
    float largest = 0;
    for (std::uint32_t i = 0; i < position.size(); ++i) {
        const SlabPlaces at = slab_places(position[i]);
        const std::uint32_t first = sets.find(i);
        if (first == i) {
            part[i] = static_cast<std::uint32_t>(parts_.size());
            parts_.push_back({at, at});
        }
        Part& own = parts_[part[first]];
        for (std::size_t k = 0; k < kDirections; ++k) {
            own.low[k] = std::min(own.low[k], at[k]);
            own.high[k] = std::max(own.high[k], at[k]);
            largest = std::max(largest, std::abs(at[k]));
        }
    }
    constexpr float kRoundings = 16 * 0x1p-23f;
    error_ = kRoundings * largest;
    if (parts_.empty()) return;
    sort_parts();
    join_parts();
}

void SeparateBodies::sort_parts() {
    Part all;
    all.low.fill(std::numeric_limits<float>::max());
    all.high.fill(std::numeric_limits<float>::lowest());
    for (const SeparateBodies::Part& part : parts_) {
        for (std::size_t k = 0; k < 3; ++k) {
            all.low[k] = std::min(all.low[k], part.low[k]);
            all.high[k] = std::max(all.high[k], part.high[k]);
        }
    }
    for (std::size_t k = 1; k < 3; ++k) {
        if (all.high[k] - all.low[k] > all.high[axis_] - all.low[axis_]) axis_ = k;
    }
    std::ranges::stable_sort(parts_, {},
                             [this](const SeparateBodies::Part& part) { return part.low[axis_]; });
    for (const SeparateBodies::Part& part : parts_) {
        reach_.push_back(reach_.empty() ? part.high[axis_]
                                        : std::max(reach_.back(), part.high[axis_]));
    }
}

void SeparateBodies::join_parts() {
    formats::DisjointSets sets(parts_.size());
    std::size_t compared = 0;
    for (std::uint32_t i = 0; i < parts_.size(); ++i) {
        const float low = parts_[i].low[axis_] - error_;
        for (std::uint32_t j = i; j-- > 0 && reach_[j] >= low;) {
            if (++compared > kMostComparisons) {
                count_ = 1;
                return;
            }
            if (do_meet(parts_[i], parts_[j], error_)) sets.join(i, j);
        }
    }
    for (std::uint32_t i = 0; i < parts_.size(); ++i) {
        const std::uint32_t first = sets.find(i);
        parts_[i].body = first == i ? count_++ : parts_[first].body;
    }
}

std::uint32_t SeparateBodies::body_at(const glm::vec3& point) const {
    if (count_ <= 1) return 0;
    const SlabPlaces at = slab_places(point);
    const auto above = std::ranges::upper_bound(
        parts_, at[axis_] + error_, {},
        [this](const SeparateBodies::Part& part) { return part.low[axis_]; });
    const auto end = static_cast<std::size_t>(above - parts_.begin());
    for (std::size_t i = end; i-- > 0 && reach_[i] >= at[axis_] - error_;) {
        if (distance_outside(parts_[i], at) <= error_) return parts_[i].body;
    }
    return std::ranges::min_element(
               parts_, {},
               [&](const SeparateBodies::Part& part) { return distance_outside(part, at); })
        ->body;
}

}  // namespace opaline::bake
