#include "bake/exchange/lamps/surface_elements.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace opaline::bake {
namespace {

constexpr std::uint32_t kMostLevels = 11;  // 4^11 elements of a triangle

std::uint32_t count_sides(const formats::Scene& scene, const formats::Primitive& primitive) {
    const formats::Material& material = scene.materials[primitive.material];
    return material.double_sided || material.sheet ? 2 : 1;
}

double triangle_area(const formats::Primitive& primitive, std::size_t first_index) {
    const std::uint32_t* const i = &primitive.index[first_index];
    const glm::dvec3 a(primitive.position[i[0]]);
    return 0.5 * glm::length(glm::cross(glm::dvec3(primitive.position[i[1]]) - a,
                                        glm::dvec3(primitive.position[i[2]]) - a));
}

// Of the 4^level triangles: corner k's is child k, the middle one child 3. Its digits, base 4, are
// those of its ancestors.
std::uint32_t element_index(glm::dvec3 weights, std::uint32_t level) {
    std::uint32_t index = 0;
    for (; level > 0; --level) {
        std::uint32_t child = 3;
        for (int k = 0; k < 3; ++k) {
            if (weights[k] > 0.5) child = static_cast<std::uint32_t>(k);
        }
        if (child == 3) {
            weights = glm::dvec3(1) - 2.0 * weights;
        } else {
            weights = 2.0 * weights;
            weights[static_cast<int>(child)] -= 1;
        }
        index = 4 * index + child;
    }
    return index;
}

// Barycentric weights of the middle of a triangle of element_index.
glm::dvec3 element_middle(std::uint32_t index, std::uint32_t level) {
    glm::dvec3 middle(1.0 / 3);
    for (; level > 0; --level, index /= 4) {
        const std::uint32_t child = index % 4;
        middle *= 0.5;
        if (child == 3) {
            middle = glm::dvec3(0.5) - middle;
        } else {
            middle[static_cast<int>(child)] += 0.5;
        }
    }
    return middle;
}

}  // namespace

bool has_light(std::span<const ElementDeposit> deposits) {
    return std::ranges::any_of(deposits,
                               [](const ElementDeposit& of) { return of.power != glm::dvec3(0); });
}

double reflecting_area(const formats::Scene& scene) {
    double sum = 0;
    for (const formats::Primitive& primitive : scene.primitives) {
        sum += count_sides(scene, primitive) * formats::surface_area(primitive);
    }
    return sum;
}

ElementLayout::ElementLayout(const formats::Scene& scene, double finest) {
    for (const formats::Primitive& primitive : scene.primitives) {
        first_.push_back(static_cast<std::uint32_t>(hierarchies_.size()));
        sides_.push_back(count_sides(scene, primitive));
        clusters_.push_back(cluster_triangles(primitive));
        for (std::size_t i = 0; i + 2 < primitive.index.size(); i += 3) {
            const double area = triangle_area(primitive, i);
            std::uint32_t levels = 0;
            for (double part = area / 4; part >= finest && levels < kMostLevels; part /= 4) {
                ++levels;
            }
            for (std::uint32_t side = 0; side < sides_.back(); ++side) {
                hierarchies_.push_back({static_cast<std::uint32_t>(size_), levels, area});
                size_ += std::size_t{1} << (2 * levels);
            }
        }
    }
}

const ElementLayout::Hierarchy* ElementLayout::find(const TriangleSide& side) const {
    const std::uint32_t sides = sides_[side.primitive];
    if (side.is_back && sides == 1) return nullptr;
    return &hierarchies_[first_[side.primitive] + side.first_index / 3 * sides +
                         (side.is_back ? 1 : 0)];
}

std::size_t ElementLayout::element(const TriangleSide& side, const glm::dvec3& weights) const {
    const Hierarchy* const hierarchy = find(side);
    if (hierarchy == nullptr) return size_;
    return hierarchy->first + element_index(weights, hierarchy->levels);
}

std::vector<ElementPlace> ElementLayout::places(const formats::Scene& scene) const {
    std::vector<ElementPlace> places(size_);
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const formats::Primitive& primitive = scene.primitives[p];
        for (std::uint32_t i = 0; i + 2 < primitive.index.size(); i += 3) {
            std::array<glm::dvec3, 3> corner;
            for (std::size_t c = 0; c < 3; ++c) {
                corner[c] = glm::dvec3(primitive.position[primitive.index[i + c]]);
            }
            const glm::dvec3 up = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
            const glm::dvec3 normal = up == glm::dvec3(0) ? up : glm::normalize(up);
            for (std::uint32_t side = 0; side < sides_[p]; ++side) {
                const Hierarchy& own = hierarchies_[first_[p] + i / 3 * sides_[p] + side];
                for (std::uint32_t e = 0; e < 1u << (2 * own.levels); ++e) {
                    const glm::dvec3 w = element_middle(e, own.levels);
                    places[own.first + e] = {
                        glm::vec3(w.x * corner[0] + w.y * corner[1] + w.z * corner[2]),
                        glm::vec3((side == 0 ? 1.0 : -1.0) * normal), primitive.material, side != 0,
                        static_cast<float>(
                            std::ldexp(own.area, -2 * static_cast<int>(own.levels)))};
                }
            }
        }
    }
    return places;
}

}  // namespace opaline::bake
