#pragma once

#include <cstdint>

namespace opaline::bake {

/// The light of a path belongs to exactly one of these, by what the path did between the receiver
/// and the sky. The first two of a body's are what the bake's effects of the same name stand for.
using Terms = std::uint32_t;
namespace term {
inline constexpr Terms kDiffuse = 1;       ///< one reflection from an opaque surface
inline constexpr Terms kSingle = 2;        ///< into a body, scattered once, out again
inline constexpr Terms kMultiple = 4;      ///< into a body, scattered more often or reflected at
                                           ///< its boundary from inside, out again
inline constexpr Terms kSpecular = 8;      ///< one mirror reflection, at a body's boundary or by
                                           ///< the specular lobe of an opaque surface
inline constexpr Terms kUnscattered = 16;  ///< through a body without being scattered
inline constexpr Terms kInterreflection = 32;  ///< everything that met a second body or surface
inline constexpr Terms kAll = 63;
}  // namespace term

/// What a path has met so far, as far as its term depends on it.
struct PathState {
    enum class Stage : std::uint8_t {
        camera,    ///< nothing: what it sees is background
        diffuse,   ///< one opaque surface
        mirrored,  ///< the outside of one body, or the specular lobe of one opaque surface
        inside,    ///< in the first body
        left,      ///< out of the first body
        other      ///< more
    } stage = Stage::camera;
    std::uint8_t scatterings = 0;  ///< in the first body, at most 2
    bool reflected_inside = false;
};

/// Transitions.
constexpr PathState after_diffuse(PathState s) {
    s.stage =
        s.stage == PathState::Stage::camera ? PathState::Stage::diffuse : PathState::Stage::other;
    return s;
}
constexpr PathState after_scattering(PathState s) {
    if (s.stage == PathState::Stage::inside) {
        s.scatterings = static_cast<std::uint8_t>(s.scatterings < 2 ? s.scatterings + 1 : 2);
    } else {
        s.stage = PathState::Stage::other;
    }
    return s;
}
constexpr PathState after_reflection(PathState s) {
    if (s.stage == PathState::Stage::inside) {
        s.reflected_inside = true;
    } else {
        s.stage = s.stage == PathState::Stage::camera ? PathState::Stage::mirrored
                                                      : PathState::Stage::other;
    }
    return s;
}
/// By the specular lobe of an opaque surface.
constexpr PathState after_gloss(PathState s) {
    s.stage =
        s.stage == PathState::Stage::camera ? PathState::Stage::mirrored : PathState::Stage::other;
    return s;
}
/// Through a boundary; `out`: no body is around it any more.
constexpr PathState after_crossing(PathState s, bool out) {
    if (s.stage == PathState::Stage::camera && !out) {
        s.stage = PathState::Stage::inside;
    } else {
        s.stage = s.stage == PathState::Stage::inside && out ? PathState::Stage::left
                                                             : PathState::Stage::other;
    }
    return s;
}

/// The term of a path that now reaches the sky; the camera's own view of it counts as all.
constexpr Terms term_of(PathState s) {
    switch (s.stage) {
        case PathState::Stage::camera:
            return term::kAll;
        case PathState::Stage::diffuse:
            return term::kDiffuse;
        case PathState::Stage::mirrored:
            return term::kSpecular;
        case PathState::Stage::inside:  // the body is open: such light is not counted
            return 0;
        case PathState::Stage::left:
            return s.scatterings == 0                          ? term::kUnscattered
                   : s.scatterings == 1 && !s.reflected_inside ? term::kSingle
                                                               : term::kMultiple;
        case PathState::Stage::other:
            break;
    }
    return term::kInterreflection;
}

/// All terms that a path may still end in.
constexpr Terms reachable_terms(PathState s) {
    switch (s.stage) {
        case PathState::Stage::camera:
            return term::kAll;
        case PathState::Stage::inside: {
            Terms terms = term::kMultiple | term::kInterreflection;
            if (s.scatterings == 0) {
                terms |= term::kUnscattered;
            }
            if (s.scatterings < 2 && !s.reflected_inside) {
                terms |= term::kSingle;
            }
            return terms;
        }
        default:
            return term_of(s) | term::kInterreflection;
    }
}

}  // namespace opaline::bake
