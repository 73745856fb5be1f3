#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "bake/reference/hit_scene.h"
#include "bake/scene/texture_pyramid.h"

namespace opaline::bake {

/// Four numbers side by side.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

inline float sum4(Float4 v) {
    return (v[0] + v[1]) + (v[2] + v[3]);
}

inline bool any4(Int4 is_true) {
    return (is_true[0] | is_true[1] | is_true[2] | is_true[3]) != 0;
}

inline Float4 sqrt4(Float4 v) {
    return Float4{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
}

/// Four vectors side by side.
struct Vectors4 {
    Float4 x{}, y{}, z{};

    glm::vec3 lane(std::size_t i) const { return {x[i], y[i], z[i]}; }
    void set_lane(std::size_t i, glm::vec3 v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

inline Vectors4 operator+(const Vectors4& a, const Vectors4& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vectors4 operator-(const Vectors4& a, const Vectors4& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vectors4 operator*(Float4 s, const Vectors4& a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Vectors4 operator*(float s, const Vectors4& a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Vectors4 operator*(Float4 s, glm::vec3 a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Float4 dot(glm::vec3 a, const Vectors4& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Float4 dot(const Vectors4& a, const Vectors4& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vectors4 cross(glm::vec3 a, const Vectors4& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vectors4 cross(const Vectors4& a, glm::vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// How textures are filtered over the footprints of the eye's paths.
struct TextureFiltering {
    ScenePyramids pyramids;
    /// Full length that each random number of a path moves by, in (0, 1]: N^(-1/2) of N paths.
    float step = 1;
    /// From the second scattering on, ln of the density changes by at most this over a step;
    /// infinite: no limit [Suykens2001].
    float gradient_limit = std::numeric_limits<float>::infinity();
    float extent = 1;  ///< [m] diameter of the scene; footprints are at most a quarter of it
};

/// What is similar to a path: how its vertices move with its random numbers, up to the surface that
/// it has reached. It follows the path and changes nothing of it. A fast form of PathDifferential
/// (bake/physics/path_differentials): single precision, four columns side by side, steps multiplied
/// into them, second moments alone, at most six columns. Each scattering adds a cell of the area
/// step^2 / density around the direction that was drawn; older columns turn with the normal.
class PathFilter {
  public:
    /// `dD_dx`, `dD_dy`: change of the unit direction over a pixel.
    PathFilter(const TextureFiltering& filtering, glm::vec3 dD_dx, glm::vec3 dD_dy);

    /// Along `direction` to a hit. True if its material has a texture to look up over a footprint.
    bool arrive(const formats::Scene& scene, glm::vec3 direction, const SurfaceHit& hit);
    /// At the hit that it arrived at last.
    TextureView view() const { return {filtering_->pyramids, moments_}; }

    /// Events at that hit. `normal`: the shading normal on the side that the path came from, unit;
    /// `direction`: the path's before the event.
    void mirror(glm::vec3 direction, glm::vec3 normal);
    /// `ratio`: index beyond over index on this side.
    void refract(glm::vec3 direction, glm::vec3 normal, float ratio);
    /// `drawn` by the cosine about a normal of either side. This one and the next take effect at
    /// the next hit, so that paths to the sky do not pay for it.
    void scatter_diffusely(glm::vec3 normal, glm::vec3 drawn) {
        pending_ = {Scattering::diffuse, glm::vec3(0), normal, drawn, 1, 0};
    }
    /// `drawn` by visible normals of GGX width `alpha`: reflected, or refracted to an index `ratio`
    /// times that on this side, which is not 1.
    void scatter_on_facets(glm::vec3 direction, glm::vec3 normal, float alpha, glm::vec3 drawn,
                           float ratio = 0) {
        pending_ = {Scattering::facets, direction, normal, drawn, alpha, ratio};
    }

  private:
    /// How the vertex moves with four random numbers, each over its step. Those that are not there
    /// are 0.
    struct Block {
        Vectors4 dP, dD;
        Float4 limit{1, 1, 1, 1};  ///< the limited step over the step, not yet applied
    };
    static constexpr std::size_t kMost = 6, kMerged = 4;

    /// Of the two numbers that drew a direction.
    struct Cell {
        std::array<glm::vec3, 2> dD{};
        std::array<float, 2> limit{1, 1};
    };
    struct Refracted;

    enum class Scattering { none, diffuse, facets };
    struct Pending {
        Scattering kind = Scattering::none;
        glm::vec3 direction{0}, normal{0}, drawn{0};
        float alpha = 1;
        float ratio = 0;  ///< 0: reflection
    };

    std::span<Block> blocks() { return std::span(block_).first((count_ + 3) / 4); }
    bool is_limited() const { return std::isfinite(filtering_->gradient_limit); }
    Vectors4 normal_change(const Block& block, glm::vec3 normal) const;
    void apply_pending();
    void move_columns(glm::vec3 direction, float distance);
    void find_moments(glm::vec2 uv_v, glm::vec2 uv_w);
    void turn_facet(const Pending& event, glm::vec3 facet);
    void add_diffuse_cell(const Pending& event);
    void add_facet_cell(const Pending& event);
    void add_cell(glm::vec3 drawn, const Cell& cell);
    void merge(glm::vec3 direction);

    const TextureFiltering* filtering_;
    std::array<Block, (kMost + 3) / 4> block_;
    std::size_t count_ = 2;  ///< of numbers
    int scatterings_ = 0;
    Pending pending_;
    UvMoments moments_;
    // The triangle of the last hit and its normal; where that is interpolated: gradients of its
    // second and third weight, changes of normal along them.
    bool is_curved_ = false;
    glm::vec3 flat_{0}, gradient_v_{0}, gradient_w_{0}, normal_v_{0}, normal_w_{0}, smooth_{0};
};

}  // namespace opaline::bake
