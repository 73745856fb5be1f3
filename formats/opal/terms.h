#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "formats/opal/result.h"

namespace opaline::formats {

/// A set of components of outgoing radiance. The light of a path belongs to exactly one component:
/// light of the scene's own emitters to one, light of the sky by what the path did between the sky
/// and the receiver. Baker, reference and runtime use this one
/// type; opaline.h has flags of its own.
enum class TermSet : std::uint32_t {
    none = 0,
    multiple = 1,  ///< into a body, scattered there more than once (or reflected at its boundary
                   ///< from inside), and out again
    single = 2,    ///< into a body, scattered there once, and out again
    specular = 4,  ///< reflected once by a glossy surface: the specular lobe, opaque or translucent
    diffuse = 8,   ///< reflected once by an opaque surface: the diffuse lobe; or transmitted once
                   ///< by a thin-walled one
    unscattered = 16,       ///< through a body without being scattered
    interreflection = 32,   ///< everything that met a second body or surface
    volume_single = 64,     ///< scattered once in a volume (smoke, a cloud) and met nothing else
    volume_multiple = 128,  ///< scattered more than once in volumes and met nothing else
    emitters = 256,         ///< from surfaces and lights of the scene, whatever it met on its way
    /// What `.opal` files hold: multiple, single, specular, diffuse, and both of volumes.
    baked = 15 | volume_single | volume_multiple,
    separable = 3,  ///< what a body's rows hold as one or, if asked for, apart
    all = 511
};

constexpr TermSet operator|(TermSet a, TermSet b) {
    return static_cast<TermSet>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr TermSet operator&(TermSet a, TermSet b) {
    return static_cast<TermSet>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
constexpr TermSet operator~(TermSet a) {
    return static_cast<TermSet>(~static_cast<std::uint32_t>(a) &
                                static_cast<std::uint32_t>(TermSet::all));
}
constexpr TermSet& operator|=(TermSet& a, TermSet b) {
    return a = a | b;
}
/// Whether the set has any member of `part`.
constexpr bool has_any(TermSet set, TermSet part) {
    return (set & part) != TermSet::none;
}
/// Whether the set has all members of `part`.
constexpr bool has_all(TermSet set, TermSet part) {
    return (set & part) == part;
}

/// Names of the members in the order of their bits: "multiple,single".
std::string term_names(TermSet terms, std::string_view separator = ",");

/// The set that `text` names: "all" or nothing for the whole of `allowed`, otherwise names of its
/// members, separated by commas. `option` is for messages. Errors: usage, listing the names.
Result<TermSet> parse_terms(std::string_view text, TermSet allowed, const std::string& option);

}  // namespace opaline::formats
