#include "bake/effects/interreflection/bounce_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/effects/interreflection/scatterers.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kAxes = 6;

std::size_t first_of(std::uint32_t material, bool behind) {
    return (std::size_t{2} * material + (behind ? 1 : 0)) * kAxes;
}

glm::vec3 axis_of(std::size_t number) {
    glm::vec3 axis(0);
    axis[static_cast<glm::length_t>(number / 2)] = number % 2 == 0 ? 1.0f : -1.0f;
    return axis;
}

std::size_t nearest_axis(glm::vec3 normal) {
    std::size_t best = 0;
    for (std::size_t a = 1; a < kAxes; ++a) {
        if (glm::dot(normal, axis_of(a)) > glm::dot(normal, axis_of(best))) {
            best = a;
        }
    }
    return best;
}

}  // namespace

BounceTree::BounceTree(std::span<const Scatterer> scatterers, std::size_t materials,
                       std::size_t row_size)
    : roots_(2 * kAxes * materials, formats::kNone), row_size_(row_size) {
    std::vector<std::vector<std::uint32_t>> members(roots_.size());
    for (std::uint32_t i = 0; i < scatterers.size(); ++i) {
        const Scatterer& s = scatterers[i];
        members[first_of(s.material, s.behind) + nearest_axis(s.normal)].push_back(i);
    }
    nodes_.reserve(2 * scatterers.size());
    for (std::size_t group = 0; group < members.size(); ++group) {
        if (!members[group].empty()) {
            roots_[group] = static_cast<std::uint32_t>(nodes_.size());
            build(scatterers, members[group]);
        }
    }
    rows_.resize(nodes_.size() * row_size_);
}

void BounceTree::build(std::span<const Scatterer> scatterers, std::span<std::uint32_t> members) {
    const std::size_t self = nodes_.size();
    nodes_.push_back({.count = static_cast<std::uint32_t>(members.size()), .axis = members[0]});
    if (members.size() == 1) {
        return;
    }
    glm::vec3 low(scatterers[members[0]].position), high(low);
    for (const std::uint32_t i : members) {
        low = glm::min(low, scatterers[i].position);
        high = glm::max(high, scatterers[i].position);
    }
    const glm::vec3 extent = high - low;
    const glm::length_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                               : extent.y >= extent.z                       ? 1
                                                                            : 2;
    const auto half = static_cast<std::ptrdiff_t>(members.size() / 2);
    std::nth_element(members.begin(), members.begin() + half, members.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                         const float x = scatterers[a].position[axis];
                         const float y = scatterers[b].position[axis];
                         return x < y || (x == y && a < b);
                     });
    float below = low[axis];
    for (const std::uint32_t i : members.first(static_cast<std::size_t>(half))) {
        below = std::max(below, scatterers[i].position[axis]);
    }
    const float above = scatterers[members[static_cast<std::size_t>(half)]].position[axis];
    nodes_[self].axis = static_cast<std::uint32_t>(axis);
    nodes_[self].split = 0.5f * (below + above);
    // Cells of scatterers reach beyond their own places: as far as n + 1 of them over n gaps.
    const float wider = std::sqrt(static_cast<float>(members.size())) /
                        std::max(1.0f, std::sqrt(static_cast<float>(members.size())) - 1);
    const float second =
        std::max(std::min(extent.x, extent.y), std::min(std::max(extent.x, extent.y), extent.z));
    nodes_[self].area = wider * wider * extent[axis] * second;
    build(scatterers, members.first(static_cast<std::size_t>(half)));
    nodes_[self].right = static_cast<std::uint32_t>(nodes_.size());
    build(scatterers, members.subspan(static_cast<std::size_t>(half)));
}

void BounceTree::set_rows(std::span<const float> rows) {
    for (std::size_t v = nodes_.size(); v-- > 0;) {
        const Node& node = nodes_[v];
        float* const to = &rows_[v * row_size_];
        if (node.right == 0) {
            std::copy_n(&rows[node.axis * row_size_], row_size_, to);
            continue;
        }
        const auto left_count = static_cast<float>(nodes_[v + 1].count);
        const auto right_count = static_cast<float>(nodes_[node.right].count);
        const float left = left_count / (left_count + right_count), right = 1 - left;
        const float* const a = &rows_[(v + 1) * row_size_];
        const float* const b = &rows_[node.right * row_size_];
        for (std::size_t k = 0; k < row_size_; ++k) {
            to[k] = left * a[k] + right * b[k];
        }
    }
}

std::uint32_t BounceTree::root_of(const SurfaceSide& side) const {
    const std::size_t first = first_of(side.material, side.behind);
    std::uint32_t best = roots_[first + nearest_axis(side.normal)];
    float facing = -1;
    for (std::size_t a = 0; best == formats::kNone && a < kAxes; ++a) {
        const float own = glm::dot(side.normal, axis_of(a));
        if (roots_[first + a] != formats::kNone && own > facing) {
            facing = own;
        }
    }
    for (std::size_t a = 0; best == formats::kNone && facing > -1 && a < kAxes; ++a) {
        if (roots_[first + a] != formats::kNone && glm::dot(side.normal, axis_of(a)) == facing) {
            best = roots_[first + a];
        }
    }
    return best;
}

std::uint32_t BounceTree::find(glm::vec3 y, const SurfaceSide& side, float footprint) const {
    std::uint32_t v = root_of(side);
    while (v != formats::kNone && nodes_[v].right != 0 && nodes_[v].area > footprint) {
        v = y[static_cast<glm::length_t>(nodes_[v].axis)] < nodes_[v].split ? v + 1
                                                                            : nodes_[v].right;
    }
    return v;
}

}  // namespace opaline::bake
