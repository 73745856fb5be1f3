#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>

#include "bake/physics/path_differentials/bounded_change.h"
#include "bake/physics/path_differentials/footprint.h"
#include "bake/physics/path_differentials/lobe.h"

namespace opaline::bake {

/// What a path's steps and footprints are.
struct DifferentialRules {
    double samples = 1;  ///< paths of the whole estimate
    /// From the second scattering on, a column's contribution changes by at most e^(+-limit / 2)
    /// within its step; > 0, infinite: by any factor.
    double gradient_limit = 0.7;
    double extent = 1;  ///< diameter of the scene [m]; footprints are at most a quarter of it
};

/// The columns of a path at its current vertex; 600 bytes. It reads what was sampled and changes
/// nothing of it. Events apply in the order of the path.
struct PathDifferential {
    static constexpr std::size_t kMost = 8;
    std::array<DifferentialColumn, kMost> column{};
    std::size_t count = 0;
    int variables = 0;         ///< continuous random numbers so far
    int scatterings = 0;       ///< events that drew a direction
    double survival = 1;       ///< product of probabilities of surviving, and of discrete choices
    double polygon_scale = 1;  ///< lengths of the polygon, before over after merging

    std::span<DifferentialColumn> columns() { return std::span(column).first(count); }
    std::span<const DifferentialColumn> columns() const { return std::span(column).first(count); }
};

/// One more random number. Precondition: fewer than kMost columns.
void add_variable(PathDifferential& path, const DifferentialColumn& column);

/// Of every number of a path: (samples survival)^(-1 / variables), at most 1, the domain. None: 1.
/// A step is a full length: the number lies within half of it on either side.
double global_step(double samples, int variables, double survival);

/// The step of a column: its own share of the path's, limited where its contribution varies.
double column_step(const PathDifferential& path, const DifferentialRules& rules,
                   const DifferentialColumn& column);

/// To a surface with geometric normal N_g at distance t along D.
void move_to_surface(PathDifferential& path, const glm::dvec3& D, const glm::dvec3& N_g, double t);

/// Mirror and refraction; dN_dP: SurfaceShape's, facing as the event's N does.
void reflect_columns(PathDifferential& path, const Mirror& event, const glm::dmat3& dN_dP);
void refract_columns(PathDifferential& path, const DifferentialRules& rules,
                     const Refraction& event, const glm::dmat3& dN_dP);

/// The direction becomes the normal, the axis of a diffuse lobe.
void aim_at_normal(PathDifferential& path, const glm::dmat3& dN_dP);

/// A direction drawn from a lobe around the current direction: mirrored, refracted, the normal, or
/// the direction of propagation.
struct LobeEvent {
    glm::dvec3 axis{0, 0, 1};  ///< the current direction
    Lobe lobe{};
    double u = 0.5, v = 0.5;
    std::optional<glm::dvec3> N_g{};  ///< nothing: in a volume
};

/// Turns the columns with the axis, merges them if there are more than six, and adds those of u and
/// v. The lobe is counted as a factor of the contribution. Returns the sampled direction.
glm::dvec3 scatter_in_lobe(PathDifferential& path, const DifferentialRules& rules,
                           const LobeEvent& event);

/// A direction from a visible normal of an isotropic GGX surface.
struct FacetEvent {
    glm::dvec3 D{0, 0, -1}, N{0, 0, 1};  ///< D.N < 0
    glm::dmat3 dN_dP{0.0};
    double alpha = 0.5;
    double eta = 0;  ///< refraction: index of this side over that of the other; 0: reflection
    double u = 0.5, v = 0.5;
    glm::dvec3 N_g{0, 0, 1};
};

/// Nothing if the facet reflects totally, or the direction ends on the wrong side: the path's
/// contribution is 0. Adds no gradient.
std::optional<glm::dvec3> scatter_on_facets(PathDifferential& path, const DifferentialRules& rules,
                                            const FacetEvent& event);

/// A footprint on a surface.
struct SurfaceFootprint {
    glm::dvec3 A{0}, B{0};  ///< in the tangent plane [m]
    double area = 0;        ///< |A x B| [m^2]
    PairExtent extent;      ///< singular values [m]
};

/// polygon: worst case, area exact, for elements; filter: second moments, for textures.
enum class FootprintMode { polygon, filter };

SurfaceFootprint surface_footprint(const PathDifferential& path, const DifferentialRules& rules,
                                   const glm::dvec3& N_g, FootprintMode mode);

/// The same in texture coordinates, which change by duv_dP [1/m] over the surface.
inline FootprintPair footprint_in_texture(const SurfaceFootprint& footprint,
                                          const glm::dmat3x2& duv_dP) {
    return {duv_dP * footprint.A, duv_dP * footprint.B};
}

}  // namespace opaline::bake
