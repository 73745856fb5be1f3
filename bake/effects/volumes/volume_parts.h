#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "bake/effects/volumes/plan_volumes.h"
#include "bake/plan/knobs.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Volumes as they are baked, with voxels joined as their layouts say. A volume with dense and thin
/// places is divided into several volumes with their own node spacing. Densities are linear between
/// voxels, so the parts add up to the whole everywhere, and light blends between the nodes of two
/// parts as their densities do, without a seam (README.md, "Parts").
struct VolumeParts {
    std::optional<formats::Scene> scene;  ///< the parts, nothing else; nothing: as given
    std::vector<VolumeLayout> layouts;    ///< VolumeLayout::volume counts among these

    const formats::Scene& scene_or(const formats::Scene& given) const {
        return scene ? *scene : given;
    }
};

/// Bricks of a part have the same distance of nodes, by choose_spacing. A volume stays whole where
/// parts would save less than a quarter of the nodes that it has with the closest of these
/// distances, or have more than half as many again as with its own; where it glows, where its
/// albedo varies, where the distance is given, and where there would be more than the four volumes
/// that OpenGL draws.
VolumeParts part_volumes(const formats::Scene& scene, std::span<const VolumeLayout> layouts,
                         const Knobs& knobs);

/// Nodes of a volume in its parts, or whole. `layout`: of it, with its spacing.
std::size_t count_nodes_of_parts(const formats::Scene& scene, const formats::Volume& volume,
                                 const VolumeLayout& layout, const Knobs& knobs);

}  // namespace opaline::bake
