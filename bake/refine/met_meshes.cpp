#include "bake/refine/met_meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>

#include "bake/scene/weld.h"

namespace opaline::bake {

MetMeshes::MetMeshes(const formats::Scene& scene) : scene_(scene) {
    const auto add = [&](std::uint32_t place, std::uint32_t first, std::uint32_t count,
                         glm::vec3 offset, const Box& own) {
        const Box box{own.low + offset, own.high + offset};
        by_width_[std::ilogb(box.high.x - box.low.x)].push_back({place, first, count, offset, box});
    };
    std::unordered_map<std::uint32_t, Box> originals;
    std::vector<std::uint32_t> count(scene.primitives.size(), 1);  // of the mesh that begins there
    for (const CopiedMesh& mesh : find_copied_meshes(scene)) {
        auto found = originals.find(mesh.original);
        if (found == originals.end()) {
            found = originals.emplace(mesh.original, box_of(mesh.original, mesh.count)).first;
        }
        add(mesh.first, mesh.original, mesh.count, mesh.offset, found->second);
        count[mesh.original] = mesh.count;
    }
    for (std::uint32_t p = 0; p < scene.primitives.size(); p += count[p]) {
        if (scene.primitives[p].position.empty()) continue;
        add(p, p, count[p], glm::vec3(0), box_of(p, count[p]));
    }
    for (auto& [width, meshes] : by_width_) {
        std::ranges::sort(meshes, {}, [](const Mesh& mesh) { return mesh.box.low.x; });
    }
}

MetMeshes::Box MetMeshes::box_of(std::uint32_t first, std::uint32_t count) const {
    Box box{glm::vec3(std::numeric_limits<float>::max()),
            glm::vec3(std::numeric_limits<float>::lowest())};
    for (std::uint32_t p = first; p < first + count; ++p) {
        for (const glm::vec3& at : scene_.primitives[p].position) {
            box = {glm::min(box.low, at), glm::max(box.high, at)};
        }
    }
    return box;
}

bool MetMeshes::share_a_vertex(const Mesh& a, const Mesh& b) {
    const glm::vec3 low = glm::max(a.box.low, b.box.low), high = glm::min(a.box.high, b.box.high);
    if (glm::any(glm::lessThan(high, low))) return false;
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
    std::uint64_t work = 0;
    for (const Mesh* mesh : {&a, &b}) {
        for (std::uint32_t p = mesh->first; p < mesh->first + mesh->count; ++p) {
            work += scene_.primitives[p].position.size();
        }
    }
    if (work > work_left_) return true;
    work_left_ -= work;
    std::unordered_set<glm::vec3, PositionHash> places;
    for_places(a, [&](glm::vec3 at) { places.insert(at); });
    bool shares = false;
    for_places(b, [&](glm::vec3 at) { shares = shares || places.contains(at); });
    return shares;
}

bool MetMeshes::meets_another(const CopiedMesh& copy) {
    const Box own = box_of(copy.original, copy.count);
    const Mesh self{copy.first,
                    copy.original,
                    copy.count,
                    copy.offset,
                    {own.low + copy.offset, own.high + copy.offset}};
    for (const auto& [width, meshes] : by_width_) {
        // What begins before this ends before the copy begins.
        const float first = self.box.low.x - std::ldexp(1.0f, std::min(width, 125) + 1);
        auto mesh =
            std::ranges::lower_bound(meshes, first, {}, [](const Mesh& m) { return m.box.low.x; });
        for (; mesh != meshes.end() && mesh->box.low.x <= self.box.high.x; ++mesh) {
            if (mesh->place != self.place && share_a_vertex(*mesh, self)) return true;
        }
    }
    return false;
}

}  // namespace opaline::bake
