#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace opaline::bake {

/// What rises above the horizons of a surface.
struct Horizon {
    /// Bound on the sine of the elevation of any point of the scene above the horizon (the plane
    /// across the shading normal) of any receiver of the material; 1: something stands there, or
    /// may. Of a convex body alone it is kLeastElevation: lower ones are not looked for.
    double elevation = 1;
    /// Largest share of the irradiance above a shading normal that comes from behind the facet,
    /// (1 - n.n_f) / 2: what the facets of a coarse body take away from points on them.
    double behind_facets = 0;
};

/// What the planner knows of the surfaces of one material, over all its primitives.
struct MaterialFacts {
    double triangles = 0, receivers = 0;
    double area = 0;                     ///< [m^2]
    double volume = 0;                   ///< [m^3], of what is closed; otherwise meaningless
    double mean_edge = 0;                ///< [m]
    glm::vec3 low{1e30f}, high{-1e30f};  ///< bounds [m]

    /// Triangles hang together over edges that just two of them share.
    std::uint32_t parts = 0;
    std::uint32_t convex_parts = 0;  ///< whose points all lie on their hull, within kMostElevation
    std::uint64_t open_edges = 0;    ///< where an odd number of triangles meet
    bool is_closed() const { return triangles > 0 && open_edges == 0; }

    Horizon horizon;

    float brightest_vertex = 0;  ///< largest component of its vertex colours; 1 without any
    float color_contrast = 0;    ///< ColorRange::contrast; 0: its colour is constant

    bool is_grey = false;  ///< a medium whose coefficients are the same in all three bands
    bool mirrors = false;  ///< a medium with a boundary: eta is not 1
};

/// What the planner knows of a scene without simulating anything.
struct SceneFacts {
    std::vector<MaterialFacts> material;  ///< as Scene::materials
    double triangles = 0, receivers = 0;

    /// Nothing stands before any light that comes from above the receivers' horizons: a convex body
    /// alone, or surfaces that are all parts of one.
    bool is_open() const;
};

/// Elevations at which less than 1/512 of a uniform light is lost: of it, sin^2 comes from lower.
inline constexpr double kMostElevation = 0.0442;
/// A millionth.
inline constexpr double kLeastElevation = 0.001;

}  // namespace opaline::bake
