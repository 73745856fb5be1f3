#include "formats/gltf/find_originals.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>

namespace opaline::formats::gltf {
namespace {

struct Shape {
    std::uint32_t mesh = 0;
    std::vector<double> weights;
    std::array<double, 9> linear{};

    auto operator<=>(const Shape&) const = default;
};

Shape shape_of(const Node& node, const glm::dmat4& world) {
    Shape shape{node.mesh, node.weights, {}};
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            // -0 and 0 are the same.
            shape.linear[static_cast<std::size_t>(3 * column + row)] = world[column][row] + 0.0;
        }
    }
    return shape;
}

}  // namespace

std::vector<std::size_t> find_originals(const Document& document,
                                        const std::vector<MeshInstance>& instances) {
    std::vector<std::size_t> original(instances.size());
    std::map<Shape, std::size_t> first;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        original[i] = i;
        if (!instances[i].joints.empty()) continue;
        const Shape shape = shape_of(document.nodes[instances[i].node], instances[i].world);
        original[i] = first.emplace(shape, i).first->second;
    }
    return original;
}

std::vector<MeshInstance> originals_of(const Document& document,
                                       const std::vector<MeshInstance>& instances) {
    const std::vector<std::size_t> original = find_originals(document, instances);
    std::vector<MeshInstance> originals;
    for (std::size_t i = 0; i < instances.size(); ++i) {
        if (original[i] == i) originals.push_back(instances[i]);
    }
    return originals;
}

}  // namespace opaline::formats::gltf
