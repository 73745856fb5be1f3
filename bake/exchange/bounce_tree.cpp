#include "bake/exchange/bounce_tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "bake/exchange/scatterers.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kMostNodes = (1u << 29) - 1;
// Below it a tree only halves its members: they are fewer than 2^29.
constexpr std::uint32_t kMostMiddles = 400;
static_assert(kMostMiddles + 29 < BounceTree::kMostWaiting);
constexpr std::size_t kSkyTexels = std::size_t{6} * kBounceCubemap * kBounceCubemap;

// Area of a facet's part in a box: that of its shadow along the nearest axis over the cosine.
float area_of(glm::vec3 extent, glm::vec3 normal) {
    constexpr float kSmallest = 1e-20f;
    const auto axis = static_cast<glm::length_t>(nearest_side_axis(normal) / 2);
    return std::max(kSmallest, extent[(axis + 1) % 3] * extent[(axis + 2) % 3] /
                                   std::max(0.5f, std::abs(normal[axis])));
}

// Product of the two longest edges of a box.
float largest_side(glm::vec3 extent) {
    const float second =
        std::max(std::min(extent.x, extent.y), std::min(std::max(extent.x, extent.y), extent.z));
    return second * std::max({extent.x, extent.y, extent.z});
}

// Orders members along an axis; returns how many go below the split: half of them. Where most lie
// in a slab, as those of one of several parallel walls do, a split between these would part them by
// rounding errors: the middle of all parts walls instead, in the first levels of the tree. Both
// parts have members: places are on both sides of the middle, or else all alike.
std::size_t split_members(std::span<const Scatterer> scatterers, std::span<std::uint32_t> members,
                          glm::length_t axis, std::uint32_t depth) {
    constexpr float kSlab = 0.01f;
    const auto place = [&](std::uint32_t i) { return scatterers[i].position[axis]; };
    std::ranges::sort(members, [&](std::uint32_t a, std::uint32_t b) {
        return place(a) < place(b) || (place(a) == place(b) && a < b);
    });
    const std::size_t n = members.size();
    const float low = place(members[0]), high = place(members[n - 1]);
    const float slab = place(members[3 * n / 5]) - place(members[2 * n / 5]);
    if (n < 5 || slab > kSlab * (high - low) || !(high > low) || depth >= kMostMiddles) {
        return n / 2;
    }
    // Of neighbouring floats the middle rounds to either.
    const float middle = std::min(0.5f * (low + high), std::nextafter(high, low));
    return static_cast<std::size_t>(
        std::ranges::partition_point(members, [&](std::uint32_t i) { return place(i) <= middle; }) -
        members.begin());
}

}  // namespace

BounceTree::BounceTree(std::span<const Scatterer> scatterers, std::size_t materials,
                       std::size_t row_size)
    : roots_(2 * kSideAxes * materials, formats::kNone), row_size_(row_size) {
    std::vector<std::vector<std::uint32_t>> members(roots_.size());
    for (std::uint32_t i = 0; i < scatterers.size(); ++i) {
        const Scatterer& s = scatterers[i];
        members[first_side_axis(s.material, s.behind) + nearest_side_axis(s.normal)].push_back(i);
    }
    nodes_.reserve(2 * scatterers.size());
    for (std::size_t group = 0; group < members.size(); ++group) {
        if (!members[group].empty()) {
            roots_[group] = static_cast<std::uint32_t>(nodes_.size());
            Box all{scatterers[members[group][0]].position, scatterers[members[group][0]].position};
            for (const std::uint32_t i : members[group]) {
                all.low = glm::min(all.low, scatterers[i].position);
                all.high = glm::max(all.high, scatterers[i].position);
            }
            build(scatterers, members[group], all, 0);
        }
    }
    rows_ = CodedRows(nodes_.size(), row_size_);
    set_sky();
    set_lobes(scatterers);
}

void BounceTree::set_lobes(std::span<const Scatterer> scatterers) {
    const std::vector<std::uint32_t> number = number_lobes(scatterers);
    lobes_.scatterers = scatterers.size();
    lobes_.count = count_lobes(number);
    if (lobes_.count == 0 || row_size_ == 0) return;
    const auto first = static_cast<std::uint32_t>(nodes_.size() + kSkyTexels);
    rows_.resize(first + lobes_.count);
    lobes_.mirrored.resize(nodes_.size());
    lobes_.irradiance.assign(nodes_.size(), formats::kNone);
    for (std::size_t v = nodes_.size(); v-- > 0;) {
        const std::uint32_t i = extents_[v].scatterer, second = nodes_[v].right;
        if (second != 0) {
            const float left = nodes_[v + 1].cell / nodes_[v].cell;
            lobes_.mirrored[v] =
                left * lobes_.mirrored[v + 1] + (1 - left) * lobes_.mirrored[second];
        } else if (number[i] != formats::kNone) {
            lobes_.mirrored[v] = scatterers[i].mirrored();
            lobes_.irradiance[v] = first + number[i];
        }
    }
}

void BounceTree::set_sky() {
    if (row_size_ == 0) return;
    rows_.resize(nodes_.size() + kSkyTexels);
    if (row_size_ % kSkyTexels != 0) return;  // of lamps, to whose light the sky adds none
    const std::vector<double> face = formats::texel_solid_angles(kBounceCubemap);
    sky_solid_angles_.assign(face.begin(), face.end());
    std::vector<float> row(row_size_);
    for (std::size_t t = 0; t < kSkyTexels; ++t) {
        for (std::size_t band = 0; band < row_size_; band += kSkyTexels) {
            const std::span<float> plane = std::span(row).subspan(band, kSkyTexels);
            std::ranges::fill(plane, 0.0f);
            plane[t] = static_cast<float>(std::numbers::pi / face[t % face.size()]);
            formats::haar_forward_cube(plane, kBounceCubemap);
        }
        rows_.set(nodes_.size() + t, row);
    }
}

std::uint32_t BounceTree::sky_node(glm::vec3 direction) const {
    return sky_solid_angles_.empty()
               ? formats::kNone
               : static_cast<std::uint32_t>(nodes_.size()) +
                     formats::texel_index(kBounceCubemap, {direction.x, direction.y, direction.z});
}

bool BounceTree::is_sky(std::uint32_t node) const {
    return node >= nodes_.size() && node < nodes_.size() + kSkyTexels;
}

void BounceTree::add_sky(std::uint32_t node, float weight, std::span<float> texels) const {
    assert(is_sky(node) && texels.size() == kSkyTexels);
    texels[node - nodes_.size()] += weight * std::numbers::pi_v<float> / solid_angle_of_sky(node);
}

float BounceTree::solid_angle_of_sky(std::uint32_t node) const {
    return !is_sky(node) ? std::numeric_limits<float>::infinity()
                         : sky_solid_angles_[(node - nodes_.size()) % sky_solid_angles_.size()];
}

float BounceTree::build(std::span<const Scatterer> scatterers, std::span<std::uint32_t> members,
                        const Box& cell, std::uint32_t depth) {
    const std::size_t self = nodes_.size();
    nodes_.push_back({});
    extents_.push_back({.scatterer = members[0]});
    float darkest = 1, brightest = 0;
    for (const std::uint32_t i : members) {
        darkest = std::min(darkest, scatterers[i].openness);
        brightest = std::max(brightest, scatterers[i].openness);
        nodes_[self].centre += (1 / static_cast<float>(members.size())) * scatterers[i].position;
    }
    nodes_[self].middle = brightness_of(0.5f * (darkest + brightest));
    nodes_[self].is_mixed =
        similarity(brightness_of(darkest), brightness_of(brightest)) < 0.5f ? 1 : 0;
    for (const std::uint32_t i : members) {
        nodes_[self].radius = std::max(nodes_[self].radius,
                                       glm::distance(scatterers[i].position, nodes_[self].centre));
    }
    if (members.size() == 1) {
        return nodes_[self].cell = area_of(cell.high - cell.low, scatterers[members[0]].normal);
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
    const std::size_t half = split_members(scatterers, members, axis, depth);
    const auto last_below = std::ranges::max(
        members.first(half), {}, [&](std::uint32_t i) { return scatterers[i].position[axis]; });
    const auto first_above = std::ranges::min(
        members.subspan(half), {}, [&](std::uint32_t i) { return scatterers[i].position[axis]; });
    nodes_[self].axis = static_cast<std::uint32_t>(axis) & 3u;
    nodes_[self].split =
        0.5f * (scatterers[last_below].position[axis] + scatterers[first_above].position[axis]);
    // Cells of scatterers reach beyond their own places: as far as n + 1 of them over n gaps.
    const float wider = std::sqrt(static_cast<float>(members.size())) /
                        std::max(1.0f, std::sqrt(static_cast<float>(members.size())) - 1);
    extents_[self].area = wider * wider * largest_side(extent);
    // Surfaces of a side lie apart: a cell ends a gap beyond its scatterers.
    Box left = cell;
    if (members.size() > 4) {
        const glm::vec3 gap = extent / (std::sqrt(static_cast<float>(members.size())) - 1);
        left = {glm::max(cell.low, low - gap), glm::min(cell.high, high + gap)};
    }
    Box right = left;
    left.high[axis] = right.low[axis] = nodes_[self].split;
    float area = build(scatterers, members.first(half), left, depth + 1);
    nodes_[self].right = static_cast<std::uint32_t>(nodes_.size()) & kMostNodes;
    area += build(scatterers, members.subspan(half), right, depth + 1);
    return nodes_[self].cell = area;
}

std::vector<std::uint32_t> BounceTree::leaves() const {
    std::vector<std::uint32_t> leaves;
    for (std::uint32_t v = 0; v < nodes_.size(); ++v) {
        if (nodes_[v].right == 0) {
            leaves.push_back(v);
        }
    }
    return leaves;
}

std::vector<float> BounceTree::cells() const {
    const std::vector<std::uint32_t> own = leaves();
    std::vector<float> cells(own.size());
    for (const std::uint32_t v : own) {
        cells[extents_[v].scatterer] = nodes_[v].cell;
    }
    return cells;
}

std::vector<std::uint32_t> BounceTree::neighbours() const {
    std::vector<std::uint32_t> order = leaves();
    std::ranges::for_each(order, [&](std::uint32_t& v) { v = extents_[v].scatterer; });
    return order;
}

// Backwards, children come before their parents, and the first child last.
std::vector<float> BounceTree::set_branch(const CodedRows& rows, Range nodes) {
    std::vector<std::vector<float>> waiting, spare;
    for (std::size_t v = nodes.end; v-- > nodes.begin;) {
        if (nodes_[v].right == 0) {
            if (spare.empty()) {
                spare.emplace_back(row_size_);
            }
            waiting.push_back(std::move(spare.back()));
            spare.pop_back();
            std::ranges::fill(waiting.back(), 0.0f);
            rows.add(extents_[v].scatterer, 1, waiting.back());
        } else {
            spare.push_back(std::move(waiting.back()));
            waiting.pop_back();
            average(v, spare.back(), waiting.back());
        }
        rows_.set(v, waiting.back());
    }
    return std::move(waiting.back());
}

void BounceTree::average(std::size_t node, std::span<const float> first,
                         std::span<float> second) const {
    const float left = nodes_[node + 1].cell / nodes_[node].cell, right = 1 - left;
    for (std::size_t k = 0; k < row_size_; ++k) {
        second[k] = left * first[k] + right * second[k];
    }
}

void BounceTree::set_rows(const CodedRows& rows, const Context& context) {
    for (std::size_t k = 0; k < lobes_.count && rows.count() > lobes_.scatterers; ++k) {
        rows_.set(nodes_.size() + kSkyTexels + k, rows.row(lobes_.scatterers + k));
    }
    constexpr std::size_t kBranch = 512;  // nodes, at most
    std::vector<std::size_t> size(nodes_.size(), 1), branches, trunk;
    for (std::size_t v = nodes_.size(); v-- > 0;) {
        if (nodes_[v].right != 0) {
            size[v] += size[v + 1] + size[nodes_[v].right];
        }
    }
    for (std::size_t v = 0; v < nodes_.size();) {
        const bool is_branch = size[v] <= kBranch;
        (is_branch ? branches : trunk).push_back(v);
        v += is_branch ? size[v] : 1;
    }
    std::vector<std::vector<float>> mean(nodes_.size());  // of branches and what holds them
    for_each_block_in_order(
        branches.size(), 1, context,
        [&](Range range) {
            const std::size_t v = branches[range.begin];
            mean[v] = set_branch(rows, {v, v + size[v]});
            return 0;
        },
        [](Range, int) {});
    if (context.cancelled()) return;
    for (std::size_t i = trunk.size(); i-- > 0;) {
        const std::size_t v = trunk[i];
        mean[v] = std::move(mean[nodes_[v].right]);
        average(v, mean[v + 1], mean[v]);
        mean[v + 1].clear();
        rows_.set(v, mean[v]);
    }
}

std::uint32_t BounceTree::root_of(const SurfaceSide& side) const {
    const std::size_t first = first_side_axis(side.material, side.behind);
    std::uint32_t best = roots_[first + nearest_side_axis(side.normal)];
    float facing = -1;
    for (std::size_t a = 0; best == formats::kNone && a < kSideAxes; ++a) {
        const float own = glm::dot(side.normal, side_axis(a));
        if (roots_[first + a] != formats::kNone && own > facing) {
            facing = own;
        }
    }
    for (std::size_t a = 0; best == formats::kNone && facing > -1 && a < kSideAxes; ++a) {
        if (roots_[first + a] != formats::kNone && glm::dot(side.normal, side_axis(a)) == facing) {
            best = roots_[first + a];
        }
    }
    return best;
}

std::uint32_t BounceTree::find(glm::vec3 y, const SurfaceSide& side, float footprint) const {
    std::uint32_t v = root_of(side);
    while (v != formats::kNone && nodes_[v].right != 0 &&
           (footprint == 0 || extents_[v].area > footprint)) {
        v = y[static_cast<glm::length_t>(nodes_[v].axis)] < nodes_[v].split ? v + 1
                                                                            : nodes_[v].right;
    }
    return v;
}

}  // namespace opaline::bake
