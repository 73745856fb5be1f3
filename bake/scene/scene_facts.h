#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

#include "formats/opal/slots.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Surfaces above the horizons of a material's receivers.
struct Horizon {
    /// Bound on the sine of the elevation of any point of the scene above the horizon (the plane
    /// across the shading normal) of any receiver of the material; 1: something may occlude. For a
    /// convex body alone it is kLeastElevation, the smallest value searched for.
    double elevation = 1;
    /// Largest share of the irradiance above a shading normal that comes from behind the facet, (1
    /// - n.n_f) / 2: the light that facets of a coarse body block at their own points.
    double behind_facets = 0;
};

/// Another medium inside a body, or beside it, where both touch or overlap.
struct InnerMedium {
    std::uint32_t material = 0;
    /// Lower bound [m], at least half, of the distance between both surfaces; 0: they meet. Of one
    /// that others lie between, the distance of the first of these.
    double depth = 0;
    formats::Medium medium;
};

/// What the surfaces of a scene may send to each other.
struct Surroundings {
    double brightest = 1;  ///< bound on the share of even light that leaves any of them again
    bool is_grey = false;  ///< they reflect all three bands alike
    double area = 0;       ///< [m^2] of all
};

/// Textures that the light of a material is multiplied by: base colour and gloss.
struct TextureFacts {
    /// Most that its albedo differs by between two points, from textures alone, in any band. All
    /// texels count, also those that no triangle shows.
    double contrast = 0;
    double texels_per_metre = 0;  ///< where they are densest, in any direction; 0: no textures
};

/// Facts about the surfaces of one material, over all its primitives.
struct MaterialFacts {
    double triangles = 0, receivers = 0;
    double area = 0;                     ///< [m^2]
    double volume = 0;                   ///< [m^3]; meaningless without has_thickness()
    double mean_edge = 0;                ///< [m]
    glm::vec3 low{1e30f}, high{-1e30f};  ///< bounds [m]

    /// Of a medium: edges where an odd number of triangles meet.
    std::uint64_t open_edges = 0;
    double sharp_edges = 0;  ///< [m] of a medium: length of its ridges of more than 45 degrees
    /// Of a medium: bound on the area of holes over that of the surface (coverage.h).
    double holes = 0;
    /// Whether volume and area say how thick it is. A body with large holes may be a sheet: only
    /// rays tell. Small ones change the volume by a few percent, as it is taken from a point of the
    /// surface.
    bool has_thickness() const {
        constexpr double kSmall = 0.1;
        return triangles > 0 && holes < kSmall && area > 0 && volume != 0;
    }

    Horizon horizon;

    float brightest_vertex = 0;  ///< largest component of its vertex colours; 1 without any
    float color_contrast = 0;    ///< ColorRange::contrast; 0: its colour is constant

    TextureFacts textures;

    /// Bound on the share of diffuse light that leaves its surface again, in any band, but for what
    /// an opaque one mirrors.
    double brightest = 1;
    Surroundings surroundings;  ///< the same of all materials

    std::vector<InnerMedium> inner;  ///< of a medium: others that light inside it may come to
    bool is_buried = false;          ///< a medium all of whose surface lies inside others
    bool overlaps = false;           ///< a medium whose bodies reach into others of it or touch

    bool may_hold_things = false;  ///< a medium whose box overlaps that of surfaces of no medium

    bool is_grey = false;  ///< a medium or sheet whose numbers, and those of media inside it, are
                           ///< the same in all three bands, everywhere
    bool mirrors = false;  ///< a medium with a boundary: eta is not 1
    bool varies = false;   ///< a medium that differs from point to point
};

/// Facts about a scene, found without simulation.
struct SceneFacts {
    std::vector<MaterialFacts> material;  ///< as Scene::materials
    double triangles = 0, receivers = 0;
    formats::Slots slots;  ///< vertices that share rows (shared_rows.h); receivers are slots then

    /// Nothing occludes light above the receivers' horizons: a single convex body, or surfaces that
    /// are all parts of one.
    bool is_open() const;
};

/// Elevations below which less than 1/512 of uniform light arrives: the fraction sin^2 theta of
/// uniform irradiance arrives below elevation theta.
inline constexpr double kMostElevation = 0.0442;
/// A millionth.
inline constexpr double kLeastElevation = 0.001;

/// Variation of a material's base colour over its surfaces.
struct ColorRange {
    float brightest_vertex =
        0;  ///< largest component of its vertex colours; 1 where there are none
    /// Largest difference of any component between two positions: vertex colour times texture times
    /// veins. 0: constant. All texels count, also those that no triangle shows.
    float contrast = 0;
};
ColorRange find_color_range(const formats::Scene& scene, std::uint32_t material);

/// `brightest`: the material's largest albedo where its textures are white.
TextureFacts find_texture_facts(const formats::Scene& scene, std::uint32_t material,
                                double brightest);

}  // namespace opaline::bake
