#include "bake/scene/parts_apart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>

#include "formats/disjoint_sets.h"

namespace opaline::bake {
namespace {

using formats::Primitive;

struct PartBox {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};

    bool meets(const PartBox& other) const {
        return glm::all(glm::lessThanEqual(low, other.high)) &&
               glm::all(glm::lessThanEqual(other.low, high));
    }
};

PartBox box_of(const Primitive& primitive) {
    PartBox box;
    for (const glm::vec3 x : primitive.position) {
        box.low = glm::min(box.low, x);
        box.high = glm::max(box.high, x);
    }
    return box;
}

float largest_coordinate(const Primitive& primitive) {
    const PartBox box = box_of(primitive);
    const glm::vec3 size = glm::max(glm::abs(box.low), glm::abs(box.high));
    return std::max({size.x, size.y, size.z});
}

}  // namespace

std::vector<std::vector<std::uint32_t>> list_parts_apart(const formats::Scene& scene,
                                                         std::uint32_t material) {
    std::vector<std::uint32_t> own;
    std::vector<PartBox> box;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        if (scene.primitives[p].material == material && !scene.primitives[p].index.empty()) {
            own.push_back(p);
            box.push_back(box_of(scene.primitives[p]));
        }
    }
    if (own.empty()) return {};
    // A sweep along the longest axis: only boxes that reach as far as the next one begins meet it.
    PartBox all;
    for (const PartBox& b : box) {
        all.low = glm::min(all.low, b.low);
        all.high = glm::max(all.high, b.high);
    }
    const glm::vec3 size = all.high - all.low;
    const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    std::vector<std::uint32_t> order(own.size()), open;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return box[i].low[axis]; });
    formats::DisjointSets sets(own.size());
    for (const std::uint32_t i : order) {
        std::erase_if(
            open, [&](std::uint32_t other) { return box[other].high[axis] < box[i].low[axis]; });
        for (const std::uint32_t other : open) {
            if (box[i].meets(box[other])) sets.join(i, other);
        }
        open.push_back(i);
    }
    std::vector<std::vector<std::uint32_t>> parts;
    std::vector<std::size_t> part(own.size());  // of the member that stands for a set
    for (std::uint32_t i = 0; i < own.size(); ++i) {
        const std::uint32_t first = sets.find(i);
        if (first == i) {
            part[i] = parts.size();
            parts.emplace_back();
        }
        parts[part[first]].push_back(own[i]);
    }
    return parts;
}

std::optional<double> scale_of_copy(const Primitive& copy, const Primitive& of) {
    const std::size_t count = of.position.size();
    if (copy.mesh != of.mesh || copy.primitive != of.primitive || count == 0 ||
        copy.position.size() != count || copy.index != of.index) {
        return std::nullopt;
    }
    // Distances from four of its vertices say where a vertex is.
    const std::array<std::size_t, 4> from{0, count / 3, 2 * count / 3, count - 1};
    const auto distances = [&](const Primitive& p, std::size_t v) {
        std::array<double, 4> d{};
        for (std::size_t k = 0; k < 4; ++k) {
            d[k] = static_cast<double>(glm::distance(p.position[v], p.position[from[k]]));
        }
        return d;
    };
    double reach = 0, scaled = 0;
    for (const std::size_t v : from) {
        for (std::size_t k = 0; k < 4; ++k) {
            reach += distances(of, v)[k];
            scaled += distances(copy, v)[k];
        }
    }
    if (!(reach > 0) || !(scaled > 0)) return std::nullopt;
    const double scale = scaled / reach;
    constexpr double kRoundings = 16 * 0x1p-23;
    const double error = kRoundings * (static_cast<double>(largest_coordinate(copy)) +
                                       scale * static_cast<double>(largest_coordinate(of)));
    for (std::size_t v = 0; v < count; ++v) {
        const auto a = distances(copy, v), b = distances(of, v);
        for (std::size_t k = 0; k < 4; ++k) {
            if (!(std::abs(a[k] - scale * b[k]) <= error)) return std::nullopt;
        }
    }
    return scale;
}

}  // namespace opaline::bake
