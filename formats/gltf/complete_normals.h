#pragma once

#include <cstddef>
#include <span>

#include "formats/gltf/report.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

/// What complete_normals made, over all instances of a scene.
struct ComputedNormals {
    std::size_t primitives = 0;  ///< without NORMAL
    std::size_t vertices = 0;    ///< copies of vertices whose faces differ in their normals
};

/// Normals for what the file leaves open, over all primitives of one mesh instance together: a
/// mesh split by material has its seams between primitives. A primitive without NORMAL is smooth
/// across edges of less than `smooth_angle` [degrees], 0: flat; a vertex with several normals keeps
/// one, and copies with the others follow on the primitive's last vertex. Of primitives with
/// NORMAL, vertices without a direction get the mean of their faces.
void complete_normals(std::span<Primitive> instance, double smooth_angle, ComputedNormals& made,
                      Report& report);

/// One line that says what was computed, if anything was.
void tell_of_normals(const ComputedNormals& made, double smooth_angle, Report& report);

}  // namespace opaline::formats::gltf
