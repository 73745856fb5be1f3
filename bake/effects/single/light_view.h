#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Marks the triangles of a material that lie inside another shell of its medium and so are no
/// boundary (README.md, "Signed depth"); in the order of the scene's primitives. Tested at four
/// points of each triangle, along three rays each. A triangle that is only partly inside, or on
/// which the rays disagree (near holes), counts as boundary. 1: inside. All zero if the context is
/// cancelled.
std::vector<std::uint8_t> find_inner_triangles(const formats::Scene& scene, const RayScene& rays,
                                               std::uint32_t material, const Context& context);

/// The boundary of a medium and everything else in a scene as one list of triangles, the boundary
/// first. Triangles within the medium are left out.
struct BodyMesh {
    std::vector<glm::vec3> position;   ///< [m], relative to `centre`
    std::vector<glm::uvec3> triangle;  ///< outward counter-clockwise
    std::uint32_t body_triangles = 0;  ///< of the medium; the rest only blocks light
    glm::vec3 centre{0};               ///< of the body's bounding box [m]
    float radius = 0;                  ///< [m] of a sphere around `centre` that holds the body
    float mean_edge = 0;               ///< [m] of the body's triangles
};

BodyMesh make_body_mesh(const formats::Scene& scene, const RayScene& rays, std::uint32_t material,
                        const Context& context);

/// Parallel projection along the light: x and y in pixels, z in metres toward the light.
struct LightFrame {
    glm::vec3 u, v, w;  ///< orthonormal, u x v = w: toward the light
    float pixels_per_metre = 1;
    glm::vec2 offset{0};  ///< [pixels]
};

/// `size` pixels across hold a sphere of `radius` [m] around the origin; `jitter` in [0, 1)^2 moves
/// the grid by less than a pixel.
LightFrame make_light_frame(glm::vec3 toward_light, float radius, std::uint32_t size,
                            glm::vec2 jitter);

glm::vec3 project(const LightFrame& frame, glm::vec3 position);

/// The topmost surface at each pixel, seen from the light; indexed by pixel_index.
struct LightLayer {
    std::vector<float> z;                 ///< [m] at the pixel's centre; -infinity: nothing
    std::vector<std::uint32_t> triangle;  ///< index into BodyMesh::triangle where z is finite
};

/// Views of a body along one direction.
struct LightView {
    std::uint32_t size = 0;  ///< [pixels]
    LightFrame frame;
    std::vector<glm::vec3> projected;  ///< vertices
    std::vector<glm::vec2> slope;      ///< of triangles in some pixel: dz/dx, dz/dy [m/pixel]
    LightLayer front;                  ///< of the body, facing the light: light enters
    LightLayer obstacle;               ///< back faces of the body, and all other surfaces
};

/// Pixels are stored in strips of eight columns, so that neighbours lie in few memory pages.
constexpr std::uint32_t kStrip = 8;

inline std::size_t pixel_index(std::uint32_t size, std::size_t column, std::size_t row) {
    return (column / kStrip * size + row) * kStrip + column % kStrip;
}

/// Renders both layers; pixel (i, j) is sampled in (i + 1/2, j + 1/2). Reuses `view`'s memory,
/// which must have seen no larger mesh.
void render_light_view(const BodyMesh& mesh, const LightFrame& frame, std::uint32_t size,
                       LightView& view);

/// The path of light to a point inside the body.
struct LightAnswer {
    bool lit = false;
    bool sure = true;    ///< false: the other members are expected values
    float distance = 0;  ///< s_i [m], of a point that may be lit
    float nearest = 0;   ///< [m] lower bound of the distance, where not sure
    /// [m] error of the distance; infinity where the point may be dark or lit.
    float uncertainty = 0;
    std::uint32_t triangle = formats::kNone;  ///< entered by the light, of a point that may be lit
};

/// Looks up a projected point. Lit: the column above it meets a known triangle of the front layer,
/// and no obstacle before it. Not sure: no triangle seen at the four nearest pixels contains the
/// column and their planes differ there by more than `tolerance` [m], or some layer lies within
/// `margin` [m] of the point.
LightAnswer look_up(const BodyMesh& mesh, const LightView& view, glm::vec3 projected,
                    float tolerance, float margin);

}  // namespace opaline::bake
