#include "bake/scene/copies.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace opaline::bake {

std::vector<CopiedMesh> find_copied_meshes(const formats::Scene& scene) {
    std::vector<CopiedMesh> meshes;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const formats::CopyOf& copy = scene.primitives[p].copy;
        if (!scene.primitives[p].is_copy()) continue;
        assert(!scene.primitives[copy.primitive].is_copy());
        CopiedMesh* const last = meshes.empty() ? nullptr : &meshes.back();
        if (last != nullptr && last->first + last->count == p && last->offset == copy.offset &&
            last->original + last->count == copy.primitive) {
            ++last->count;
        } else {
            meshes.push_back({p, 1, copy.primitive, copy.offset});
        }
    }
    return meshes;
}

std::vector<std::vector<std::uint32_t>> copies_of_primitives(const formats::Scene& scene) {
    std::vector<std::vector<std::uint32_t>> copies(scene.primitives.size());
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        if (scene.primitives[p].is_copy()) {
            copies[scene.primitives[p].copy.primitive].push_back(p);
        }
    }
    return copies;
}

formats::SceneCounts count_with(const formats::Scene& scene, std::span<const CopiedMesh> meshes) {
    formats::SceneCounts counts;
    const auto add = [&](const formats::Primitive& p) {
        counts.primitives += 1;
        counts.vertices += p.position.size();
        counts.indices += p.index.size();
    };
    std::ranges::for_each(scene.primitives, add);
    for (const CopiedMesh& mesh : meshes) {
        for (std::uint32_t p = 0; p < mesh.count; ++p) {
            add(scene.primitives[mesh.original + p]);
            counts.primitives -= 1;
        }
    }
    return counts;
}

void expand_copies(std::span<const CopiedMesh> meshes, formats::Scene& scene) {
    for (const CopiedMesh& mesh : meshes) {
        for (std::uint32_t p = mesh.first; p < mesh.first + mesh.count; ++p) {
            formats::Primitive& to = scene.primitives[p];
            formats::Primitive made = scene.primitives[to.copy.primitive];
            for (glm::vec3& at : made.position) {
                at += to.copy.offset;
            }
            made.node = to.node;
            made.name = std::move(to.name);
            to = std::move(made);
        }
    }
}

}  // namespace opaline::bake
