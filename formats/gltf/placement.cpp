#include "formats/gltf/placement.h"

#include <cmath>

namespace opaline::formats::gltf {

namespace {

bool is_mirroring(const glm::dmat4& transform) {
    return glm::determinant(glm::dmat3(transform)) < 0.0;
}

}  // namespace

Placement place_primitive(const MeshInstance& instance, const PrimitiveData& data,
                          const std::string& where, Report& report) {
    Placement out;
    out.world = instance.world;
    out.is_mirrored = is_mirroring(out.world);
    const std::vector<glm::dmat4>& joints = instance.joints;
    if (joints.empty()) return out;
    const std::size_t count = data.position.size() / 3, all = data.joint.size();
    if (data.joint.empty()) {
        report.warn(where, "its node has a skin, but it has no JOINTS_0: it is placed by its node",
                    "bind the mesh to its bones before export");
        return out;
    }
    const std::size_t per_vertex = all / count;
    out.skinned.assign(count, glm::dmat4(0.0));
    std::size_t mirrored = 0, unbound = 0;
    for (std::size_t v = 0; v < count; ++v) {
        double sum = 0;
        for (std::size_t i = v * per_vertex; i < (v + 1) * per_vertex; ++i) {
            const double weight = data.weight[i];
            if (!std::isfinite(weight) || weight < 0) {
                report.error(
                    where, "a weight of vertex " + std::to_string(v) + " is negative or not finite",
                    "normalise the weights before export");
                return out;
            }
            if (weight == 0) continue;
            if (!(data.joint[i] < static_cast<float>(joints.size()))) {
                report.error(where, "vertex " + std::to_string(v) + " is bound to joint " +
                                        std::to_string(static_cast<std::uint64_t>(data.joint[i])) +
                                        ", but its skin has " + std::to_string(joints.size()));
                return out;
            }
            out.skinned[v] += weight * joints[static_cast<std::size_t>(data.joint[i])];
            sum += weight;
        }
        if (sum > 0) {
            out.skinned[v] /= sum;
        } else {
            out.skinned[v] = joints.front();
            ++unbound;
        }
        mirrored += is_mirroring(out.skinned[v]) ? 1 : 0;
    }
    out.is_mirrored = 2 * mirrored > count;
    if (unbound > 0) {
        report.warn(where,
                    std::to_string(unbound) +
                        " vertices have no weights: they follow the skin's first joint",
                    "bind all vertices before export");
    }
    return out;
}

}  // namespace opaline::formats::gltf
