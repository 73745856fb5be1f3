#include "bake/refine/met_meshes.h"

#include <algorithm>
#include <limits>
#include <unordered_set>

#include "bake/scene/weld.h"

namespace opaline::bake {

MetMeshes::MetMeshes(const formats::Scene& scene) : scene_(scene) {
    std::vector<std::uint32_t> count(scene.primitives.size(), 1);  // of the mesh that begins there
    for (const CopiedMesh& mesh : find_copied_meshes(scene)) {
        add(mesh.original, mesh.count, mesh.offset);
        count[mesh.original] = mesh.count;
    }
    for (std::uint32_t p = 0; p < scene.primitives.size(); p += count[p]) {
        if (!scene.primitives[p].is_copy()) add(p, count[p], glm::vec3(0));
    }
}

void MetMeshes::add(std::uint32_t first, std::uint32_t count, glm::vec3 offset) {
    Mesh mesh{first, count, offset, glm::vec3(std::numeric_limits<float>::max()),
              glm::vec3(std::numeric_limits<float>::lowest())};
    for (std::uint32_t p = first; p < first + count; ++p) {
        for (const glm::vec3& at : scene_.primitives[p].position) {
            mesh.low = glm::min(mesh.low, at + offset);
            mesh.high = glm::max(mesh.high, at + offset);
        }
    }
    meshes_.push_back(mesh);
}

bool MetMeshes::meets_another(const CopiedMesh& copy) const {
    const auto is_self = [&](const Mesh& m) {
        return m.first == copy.original && m.offset == copy.offset;
    };
    const auto self = std::ranges::find_if(meshes_, is_self);
    for (const Mesh& other : meshes_) {
        const glm::vec3 low = glm::max(self->low, other.low);
        const glm::vec3 high = glm::min(self->high, other.high);
        if (&other == &*self || glm::any(glm::lessThan(high, low))) continue;
        const auto for_places = [&](const Mesh& mesh, auto&& visit) {
            for (std::uint32_t p = mesh.first; p < mesh.first + mesh.count; ++p) {
                for (const glm::vec3& own : scene_.primitives[p].position) {
                    const glm::vec3 at = own + mesh.offset;
                    if (glm::all(glm::lessThanEqual(low, at)) &&
                        glm::all(glm::lessThanEqual(at, high))) {
                        visit(weld_key(at));
                    }
                }
            }
        };
        std::unordered_set<glm::vec3, PositionHash> places;
        for_places(other, [&](glm::vec3 at) { places.insert(at); });
        bool meets = false;
        for_places(*self, [&](glm::vec3 at) { meets = meets || places.contains(at); });
        if (meets) return true;
    }
    return false;
}

}  // namespace opaline::bake
