#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"

namespace opaline::formats::gltf {

/// The data of one mesh primitive, in the mesh's frame and file units.
struct PrimitiveData {
    std::vector<float> position;  ///< 3 per vertex, finite
    std::vector<float> normal;    ///< 3 per vertex, as stored; empty if there is none
    std::vector<float> tangent;   ///< 4 per vertex, as stored; empty if there is none or not wanted
    std::vector<float> texcoord;  ///< 2 per vertex, as stored; empty if there is none
    std::vector<float> color;     ///< `color_components` per vertex; empty if there is none
    std::vector<float> joint;     ///< a multiple of 4 per vertex: numbers of a skin's joints, all
                                  ///< sets of a vertex together; empty if there are none
    std::vector<float> weight;    ///< of each joint
    std::uint32_t color_components = 3;
    std::vector<std::uint32_t> index;  ///< triangles, each < vertex count
};

/// What is read of a primitive besides positions, normals, colours and indices.
struct WantedData {
    std::uint32_t texcoord_set = 0;  ///< kNone: no texture coordinates
    bool tangents = false;
    bool joints = false;
    const std::vector<double>& morph_weights;  ///< by morph target; those past the last are unused
};

/// Reads the attributes that Opaline uses, adds what morph targets of a weight other than 0 say,
/// and makes a triangle list of strips, fans and primitives without indices. Nothing and
/// errors named after `where` if the primitive does not conform. Precondition: a triangle mode.
std::optional<PrimitiveData> read_primitive(const Document& document,
                                            const std::vector<Bytes>& buffers,
                                            const MeshPrimitive& primitive,
                                            const WantedData& wanted, const std::string& where,
                                            Report& report);

}  // namespace opaline::formats::gltf
