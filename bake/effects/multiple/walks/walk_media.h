#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/phase_table.h"
#include "bake/scene/medium_field.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Bands of light that flies alike in every medium of a space: their extinctions coincide in each.
/// Bands that scatter nowhere belong to no group.
struct WalkBands {
    float sigma_t = 0;              ///< [1/m] >= 0, of flights in the body's own medium
    std::array<float, 3> albedo{};  ///< in that medium
    std::array<bool, 3> member{};
};

/// One of the media that a walk may go through: its largest coefficients. `field` scales them down
/// at a point.
struct WalkMedium {
    float eta = 1;  ///< relative to the outside of everything
    PhaseTable phase;
    /// [1/m], of the flights of each group of bands. 0 where its bands are not scattered: they
    /// fly on to the next surface and are absorbed on the way.
    std::array<float, 3> sigma_t{};
    std::array<float, 3> albedo{};       ///< of each band, at the end of a flight in the medium
    std::array<float, 3> absorption{};   ///< [1/m] of each band that is not scattered here
    bool absorbs_in_flight = false;      ///< some absorption is not 0
    std::optional<MediumField> field{};  ///< none: it is homogeneous, or not made here
};

/// The media of a space and the groups of bands that fly alike in all of them.
struct WalkMedia {
    std::vector<WalkBands> bands;  ///< 0 to 3; none: nothing scatters
    /// The body's own first. Media that are the same to light are one.
    std::vector<WalkMedium> media;
    /// Of each medium given, its place in `media`.
    std::vector<std::uint8_t> place;
};

/// At most this many different media of one space.
inline constexpr std::size_t kMostWalkMedia = 255;

/// Without `field`. `given`: the body's own medium, then those inside it; not empty. `grey`: all
/// bands equal the first. Media beyond kMostWalkMedia have the place kNoWalkMedium.
WalkMedia make_walk_media(std::span<const formats::Medium* const> given, bool grey);
inline constexpr std::uint8_t kNoWalkMedium = 255;

/// Whether light meets no difference between two media: the same coefficients, phase function and
/// index, and neither varies in space.
bool is_same_medium(const formats::Medium& a, const formats::Medium& b);

}  // namespace opaline::bake
