#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// The primitives of one instance of a mesh that is a copy of another one: `count` of them from
/// `first` on, all with the same offset.
struct CopiedMesh {
    std::uint32_t first = 0, count = 0;
    std::uint32_t original = 0;  ///< first of as many primitives that are no copies
    glm::vec3 offset{0};         ///< [m]
};
std::vector<CopiedMesh> find_copied_meshes(const formats::Scene& scene);

/// The primitive itself, or what it is a copy of: the arrays of which it has.
inline const formats::Primitive& original_of(const formats::Scene& scene, std::size_t primitive) {
    const formats::Primitive& p = scene.primitives[primitive];
    return p.is_copy() ? scene.primitives[p.copy.primitive] : p;
}

/// Of each primitive its copies, ascending.
std::vector<std::vector<std::uint32_t>> copies_of_primitives(const formats::Scene& scene);

/// How large a scene is, its copies left out but for those of `meshes`.
formats::SceneCounts count_with(const formats::Scene& scene, std::span<const CopiedMesh> meshes);

/// Gives the primitives of these meshes arrays of their own: they are copies no more.
void expand_copies(std::span<const CopiedMesh> meshes, formats::Scene& scene);

}  // namespace opaline::bake
