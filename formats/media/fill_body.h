#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::formats {

/// A volume, and what is wrong with it.
struct FilledBody {
    Volume volume;
    std::vector<Diagnostic> warnings;
};

/// The homogeneous inside of closed meshes as a volume with cubes for voxels: the share of each
/// cube that is inside as density, along z exactly, across it by 8 x 8 lines; a point is inside
/// where triangles go around it (winding number other than 0). Edges of neighbouring triangles
/// decide alike which of both a line meets, so that no line slips through between them. Medium and
/// phase function are those of the material; its index of refraction is left out. Vertices of
/// primitives at one place are one vertex.
///
/// Warns of parts of the mesh, which hang together by their vertices, of which lines find less than
/// half, or more than one and a half times, of what they enclose: those thinner than an eighth of a
/// voxel.
///
/// `where`: of the media file's entry, for messages. `voxels`: along the longest edge of the box
/// around the meshes, in [8, 256]. Errors, `bad_input`: no material of that name or none of its
/// triangles; a material without a medium, with one that varies inside, or a sheet; meshes that are
/// not closed, or whose triangles do not face one way.
Result<FilledBody> fill_body(const Scene& scene, const std::string& material, std::uint32_t voxels,
                             const std::string& file, const std::string& where);

/// Takes the surface of a material out of the scene: its primitives stay, so that those behind them
/// keep their numbers, without vertices and triangles, the material without its medium.
void remove_surface(Scene& scene, const std::string& material);

}  // namespace opaline::formats
