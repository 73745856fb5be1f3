#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/refine/coarse_mesh.h"
#include "bake/refine/proxy_rows.h"
#include "bake/refine/receiver_spacing.h"
#include "formats/opal/slots.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A mesh of which receivers may go; its vertices are places of one primitive.
struct DensePart {
    std::uint32_t primitive = 0, first_place = 0, first_vertex = 0;
    DenseMesh mesh;
    std::vector<ProxyPoint> at;  // of each vertex; none: kNone as its triangle
    float size = 0;              // [m]
    std::vector<std::vector<SkyOutline>> outlines;
    std::vector<bool> is_asked;
    std::vector<float> spacing;
    std::vector<CoarseMix> mix;
};

/// `places`: of all primitives, offsets included; `first_vertex`: of the primitive in the scene.
DensePart make_dense_part(const formats::Scene& scene, const formats::Slots& places,
                          std::uint32_t primitive, std::uint32_t first_vertex);

/// Whether a vertex is interpolated from others.
bool is_mixed(const DensePart& part, std::uint32_t v);

/// Vertices of all parts that are not.
std::size_t count_kept(std::span<const DensePart> parts);

/// Slots of a file in which the mixed vertices of the parts have none of their own.
formats::Slots make_slots(formats::Slots places, std::span<const DensePart> parts);

}  // namespace opaline::bake
