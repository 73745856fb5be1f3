#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "bake/reference/glossy_brdf.h"
#include "bake/reference/path.h"
#include "bake/reference/path_filter.h"
#include "bake/reference/rough_boundary.h"

namespace opaline::bake {

/// Events of a path at surfaces and in media; private to the walk.

/// A path from the eye, up to its current vertex.
struct Path {
    RayOrigin origin;
    glm::vec3 direction{0};
    glm::vec3 beta{1};  ///< throughput
    SurroundingMedia stack;
    PathState state;
    std::uint32_t events = 0;
    std::uint32_t passed = 0;  ///< surfaces without an event since the last one
    std::uint32_t key = 0;     ///< of all its rays: HitScene::closest_hit
    /// [1/sr] of `direction` if the light was sampled at the last event too; else 0
    float pdf = 0;
    glm::vec3 vertex{0};                 ///< where that event was
    std::optional<PathFilter> filter{};  ///< nothing: textures are looked up at points
    glm::vec3 radiance{0};
    glm::vec3 sky{0};  ///< weight of light from `direction`, where the sky was reached
    bool lost = false;
};

/// Two sides of a boundary that a path has arrived at.
struct Crossing {
    BoundarySplit split;         ///< of a smooth one
    float alpha = 0;             ///< GGX width of its facets; 0: smooth
    glm::vec3 normal{0};         ///< that it splits at, against the path
    glm::vec3 flat{0};           ///< of the triangle, on the same side; {0,0,0} at a vertex
    float ratio = 1;             ///< index of refraction beyond over that on this side
    RayOrigin near, far;         ///< where rays start on this side and beyond
    SurroundingMedia beyond;     ///< bodies on the far side
    glm::vec3 color{1};          ///< factor of light that enters a body
    bool is_own_mirror = false;  ///< its reflection is left out: see PathOptions::own_mirror
};

/// Whether a path that reaches the sky here counts.
inline bool counts_sky(const PathSpace& space, PathState state) {
    return is_counted(state, space.options.terms, space.options.crossed, space.options.by_volumes);
}

/// True if light of the scene's own lamps is there and is counted.
inline bool counts_lamps(const PathSpace& space) {
    return !space.scene.lamps.empty() && has_any(space.options.terms, TermSet::emitters);
}

/// Whether that of a lamp that such a path meets, or is sampled from it, counts.
inline bool counts_lamps(const PathSpace& space, PathState state) {
    return counts_lamps(space) && (state.by_volume || !space.options.by_volumes);
}

/// True if volumes send out light by themselves and it is counted.
inline bool counts_glow(const PathSpace& space) {
    return !space.scene.volumes.glowing.empty() && has_any(space.options.terms, TermSet::emitters);
}

/// True if the path may still end in a term that is counted. It may meet lamps in any state.
inline bool is_wanted(const PathSpace& space, PathState state) {
    TermSet terms = space.options.terms;
    const bool is_left_out = space.options.crossed == CrossedLight::left_out && state.crossed;
    const bool may_meet_volume =
        state.stage == PathState::Stage::camera ||
        (space.options.through_volumes && state.stage != PathState::Stage::other);
    const bool is_late = space.options.by_volumes && !state.by_volume && !may_meet_volume;
    if (is_left_out || is_late) {
        terms = terms & ~TermSet::interreflection;
    }
    return has_any(reachable_terms(state), terms) || (counts_lamps(space) && !is_late) ||
           counts_glow(space);
}

/// A point of an opaque surface that a path has arrived at. Normals face the path.
struct OpaquePoint {
    RayOrigin from, behind;  ///< where rays start in front of it, and on its other side
    glm::vec3 normal{0};
    glm::vec3 flat{0};  ///< of the triangle; {0,0,0} at a vertex, which lies on several
    OpaqueSurface surface;
    bool is_own_mirror = false;  ///< its specular lobe is left out: see PathOptions::own_mirror
};

/// An opaque or thin-walled surface. A thin-walled one reflects or transmits what it scatters
/// diffusely, by chance. Of a glossy one, either lobe is taken by chance in proportion to what it
/// reflects (surely, where the other one leads to no wanted term), so that the path belongs to one
/// term; light and path are then sampled for that lobe alone. False: the path ends.
bool reflect_at_surface(const PathSpace& space, Path& path, const OpaquePoint& point,
                        RandomStream& random);

/// The path continues beyond the boundary in the same direction.
void pass_boundary(Path& path, const Crossing& crossing);

/// A boundary between different indices. The path is reflected or transmitted at random, or always
/// takes one side if the other leads to no requested term. At a rough one light is sampled too.
/// False: the path ends.
bool reflect_or_refract(const PathSpace& space, Path& path, const Crossing& crossing,
                        RandomStream& random);

/// A scattering event at a point of the medium around. False: the path ends.
bool scatter(const PathSpace& space, Path& path, glm::vec3 at, RandomStream& random);

/// A scattering event in a volume, outside of all bodies. False: the path ends.
bool scatter_in_volume(const PathSpace& space, Path& path, glm::vec3 at, std::uint32_t volume,
                       RandomStream& random);

}  // namespace opaline::bake
