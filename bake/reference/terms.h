#pragma once

#include <cstdint>

#include "formats/opal/terms.h"

namespace opaline::bake {

using formats::TermSet;

/// The state of a path on which its term depends.
struct PathState {
    enum class Stage : std::uint8_t {
        camera,    ///< nothing: what it sees is background
        diffuse,   ///< one opaque surface
        mirrored,  ///< the outside of one body, or the specular lobe of one opaque surface
        inside,    ///< in the first body, or in media inside it
        left,      ///< out of the first body
        volume,    ///< volumes alone
        other      ///< more
    } stage = Stage::camera;
    std::uint8_t scatterings = 0;  ///< since it entered the first body, or in volumes; at most 2
    bool reflected_inside = false;
    bool changed_medium = false;  ///< went from one medium to another without leaving them
    bool in_body = false;         ///< in any body
    bool is_straight = false;     ///< there, and not scattered since it entered
    bool crossed = false;         ///< went through some body without being scattered in it
    /// A volume scattered it before anything else did, but for the first surface or body where what
    /// volumes scatter to that counts as its own (PathOptions::through_volumes).
    bool by_volume = false;
};

/// Which paths of TermSet::interreflection count, by PathState::crossed.
enum class CrossedLight : std::uint8_t { counted, left_out, alone };

/// Transitions.
constexpr PathState after_diffuse(PathState s) {
    s.is_straight = false;
    s.stage =
        s.stage == PathState::Stage::camera ? PathState::Stage::diffuse : PathState::Stage::other;
    return s;
}
constexpr PathState after_scattering(PathState s) {
    s.is_straight = false;
    if (s.stage == PathState::Stage::inside) {
        s.scatterings = static_cast<std::uint8_t>(s.scatterings < 2 ? s.scatterings + 1 : 2);
    } else {
        s.stage = PathState::Stage::other;
    }
    return s;
}
/// One surface or body was met, from outside to outside, and nothing since.
constexpr bool is_on_way_to_sky(PathState s) {
    return s.stage == PathState::Stage::diffuse || s.stage == PathState::Stage::mirrored ||
           s.stage == PathState::Stage::left;
}
/// In a volume, outside of all bodies.
constexpr PathState after_volume(PathState s) {
    if (s.stage == PathState::Stage::camera || s.stage == PathState::Stage::volume) {
        s.stage = PathState::Stage::volume;
        s.by_volume = true;
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
constexpr PathState after_mirror(PathState s) {
    s.is_straight = false;
    s.stage =
        s.stage == PathState::Stage::camera ? PathState::Stage::mirrored : PathState::Stage::other;
    return s;
}
/// Through a boundary; `out`: the path is now outside all bodies.
constexpr PathState after_crossing(PathState s, bool out) {
    s.crossed = s.crossed || (out && s.is_straight);
    s.is_straight = !out && (s.is_straight || !s.in_body);
    s.in_body = !out;
    if (s.stage == PathState::Stage::camera && !out) {
        s.stage = PathState::Stage::inside;
    } else if (s.stage == PathState::Stage::inside && !out) {
        s.changed_medium = true;
    } else {
        s.stage = s.stage == PathState::Stage::inside && out ? PathState::Stage::left
                                                             : PathState::Stage::other;
    }
    return s;
}

/// Between entry, scattering events and exit: neither reflected inside nor in more than one medium.
constexpr bool takes_straight_paths(PathState s) {
    return !s.reflected_inside && !s.changed_medium;
}

/// The term of a path that reaches the sky here (of one that meets a lamp it is `emitters`); a
/// direct view of the sky counts as all terms.
constexpr TermSet term_of(PathState s) {
    switch (s.stage) {
        case PathState::Stage::camera:
            return TermSet::all;
        case PathState::Stage::diffuse:
            return TermSet::diffuse;
        case PathState::Stage::mirrored:
            return TermSet::specular;
        case PathState::Stage::inside:  // the body is open: such light is not counted
            return TermSet::none;
        case PathState::Stage::left:
            return s.scatterings == 0                              ? TermSet::unscattered
                   : s.scatterings == 1 && takes_straight_paths(s) ? TermSet::single
                                                                   : TermSet::multiple;
        case PathState::Stage::volume:
            return s.scatterings == 1 ? TermSet::volume_single : TermSet::volume_multiple;
        case PathState::Stage::other:
            break;
    }
    return TermSet::interreflection;
}

/// Whether a path that reaches the sky here counts. `by_volumes`: of TermSet::interreflection
/// those of PathState::by_volume alone.
constexpr bool is_counted(PathState s, TermSet terms, CrossedLight crossed, bool by_volumes) {
    const TermSet term = term_of(s);
    const bool has_met_more = term == TermSet::interreflection;
    return has_any(term, terms) &&
           (!has_met_more ||
            ((crossed == CrossedLight::counted || s.crossed == (crossed == CrossedLight::alone)) &&
             (s.by_volume || !by_volumes)));
}

/// All terms that a path to the sky may still end in.
constexpr TermSet reachable_terms(PathState s) {
    switch (s.stage) {
        case PathState::Stage::camera:
            return TermSet::all;
        case PathState::Stage::inside: {
            TermSet terms = TermSet::multiple | TermSet::interreflection;
            if (s.scatterings == 0) {
                terms |= TermSet::unscattered;
            }
            if (s.scatterings < 2 && takes_straight_paths(s)) {
                terms |= TermSet::single;
            }
            return terms;
        }
        case PathState::Stage::volume:
            return term_of(s) | TermSet::volume_multiple | TermSet::interreflection;
        default:
            return term_of(s) | TermSet::interreflection;
    }
}

}  // namespace opaline::bake
