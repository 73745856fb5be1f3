#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "bake/base/context.h"
#include "bake/single/entry.h"
#include "bake/visibility/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The boundary of a medium and everything else in a scene as one list of triangles, the boundary
/// first. Triangles within the medium are left out.
struct BodyMesh {
    std::vector<glm::vec3> position;   ///< [m], relative to `centre`
    std::vector<glm::uvec3> triangle;  ///< outward counter-clockwise
    std::uint32_t body_triangles = 0;  ///< of the medium; the rest only blocks light
    glm::vec3 centre{0};               ///< of the body's bounding box, world [m]
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

/// The triangle on top of a pixel, seen from the light, and its depth.
struct LightPixel {
    float z = 0;                 ///< [m] at the pixel's centre; -infinity: none
    std::uint32_t triangle = 0;  ///< index into BodyMesh::triangle, or kNone
};

/// A triangle in a view: its plane, its edges, and how light enters through it. A cache line.
struct alignas(64) ProjectedTriangle {
    glm::vec2 corner;         ///< [pixels]
    float z = 0;              ///< [m] at that corner
    glm::vec2 slope;          ///< dz/dx, dz/dy [m/pixel]
    glm::vec2 second, third;  ///< how the weights of the other corners change, per pixel
    float cosine = 0;         ///< of its normal with the light, for those of the body that face it
    Entry<float> entry;       ///< at that cosine
};

/// Views of a body along one direction.
struct LightView {
    std::uint32_t size = 0;  ///< pixels across
    LightFrame frame;
    std::vector<glm::vec3> projected;         ///< vertices
    std::vector<ProjectedTriangle> triangle;  ///< where one is drawn anywhere
    std::vector<LightPixel> front;            ///< of the body, facing the light: light enters
    std::vector<LightPixel> back;             ///< of the body, facing away: it would leave
    std::vector<LightPixel> blocker;  ///< everything else, both sides; empty if there is nothing
};

/// Renders the three layers; pixel (i, j) is sampled in (i + 1/2, j + 1/2). `boundary`: of the
/// medium. Reuses `view`'s memory.
void render_light_view(const BodyMesh& mesh, const LightFrame& frame, std::uint32_t size,
                       const Interface<float>& boundary, LightView& view);

/// The light's way from a point inside the body.
struct LightAnswer {
    bool lit = false;
    bool sure = true;    ///< otherwise all of this is only likely
    float distance = 0;  ///< s_i [m], of what may be lit
    float nearest = 0;   ///< [m] what the distance may come down to, where that is not sure
    glm::vec3 normal;    ///< n_i, world
    float cosine = 0;    ///< n_i . w
    Entry<float> entry;  ///< at that cosine
};

/// Looks a projected point up. Lit: the column through it meets a known triangle of the front layer
/// above it, and neither a back nor a blocker layer in between. Not sure: no triangle seen at the
/// four nearest pixels holds the column, and their planes differ there by more than `tolerance`
/// [m].
LightAnswer look_up(const LightView& view, glm::vec3 projected, float tolerance);

}  // namespace opaline::bake
