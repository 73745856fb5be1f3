#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/opal/rgb.h"

namespace opaline::formats {

/// A binary glTF file that shows surfaces in one light.
struct UnlitGlb {
    std::string bytes;
    std::uint32_t vertices = 0;
    std::uint32_t clipped = 0;  ///< vertices whose colour was above 1
    float largest = 0;          ///< colour of all
};

/// The meshes of an asset with COLOR_0 in place of lights: a node for each primitive that has
/// triangles, in their order, named as the scene's node by the provenance, with POSITION, indices,
/// and TEXCOORD_0 where its material has an image; materials of KHR_materials_unlit, whose image is
/// the base colour's, with what HOLE says of alpha. Vertices are as in the asset.
///
/// `color`: of every vertex, radiance [W m^-2 sr^-1], finite and >= 0; where a primitive has a base
/// colour's image, without it. COLOR_0 may not be above 1 (glTF 2.0, 3.7.2.1), and is clipped
/// there. Of thin glass, the share that lets light pass is alpha, as seen along the normal.
///
/// `name` is used in messages only. Errors: resource for a file of 4 GiB or more. Preconditions:
/// `asset` passed all checks of read_opal (Checks::full) and check_has_mesh.
Result<UnlitGlb> make_unlit_glb(const AssetView& asset, std::span<const Rgb> color,
                                const std::string& name);

/// Refuses an asset without a triangle, such as volumes alone. Errors: bad_input.
Status check_has_mesh(const AssetView& asset, const std::string& name);

}  // namespace opaline::formats
