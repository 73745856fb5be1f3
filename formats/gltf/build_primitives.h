#pragma once

#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"
#include "formats/gltf/walk_scene.h"
#include "formats/scene.h"

namespace opaline::formats::gltf {

struct PrimitiveOptions {
    double metres_per_unit = 1.0;
    double smooth_angle = 0.0;  ///< [degrees], as ImportOptions'
    bool keep_copies = false;   ///< as ImportOptions'
};

/// Fills `scene.primitives` in running-number order and `scene.origin`. Needs
/// `scene.materials`. Precondition: validate_document found no fault.
void build_primitives(const Document& document, const std::vector<MeshInstance>& instances,
                      const std::vector<Bytes>& buffers, const PrimitiveOptions& options,
                      Scene& scene, Report& report);

/// True if any of its triangles has an area above 0, in double precision.
bool has_area(const Primitive& primitive);

}  // namespace opaline::formats::gltf
