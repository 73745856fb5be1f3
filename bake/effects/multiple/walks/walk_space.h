#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/ball_bank.h"
#include "bake/scene/medium_field.h"
#include "bake/trace/bodies_at.h"
#include "bake/trace/clearance_grid.h"
#include "bake/trace/cross_bodies.h"
#include "bake/trace/embree_scene.h"
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

/// A body, its medium and the media inside it, ready for random walks.
struct WalkSpace {
    const formats::Scene* scene = nullptr;
    const EmbreeScene* triangles = nullptr;  ///< of the whole scene
    std::uint32_t material = 0;
    float eta = 1;
    bool is_grey = false;           ///< all bands equal the first
    std::vector<WalkBands> bands;   ///< 1 to 3; empty: nothing scatters
    std::vector<WalkMedium> media;  ///< the body's own, then others inside it
    /// Of each material of the scene, its medium's place in `media`; kNoWalkMedium: walks end
    /// there.
    std::vector<std::uint8_t> medium_of;
    /// Of each material, its place in order_media, where those of one medium that follow one
    /// another share a place (kNoPlace: walks end there); of each place, its medium and first
    /// material.
    std::vector<std::uint16_t> place_of;
    std::vector<std::uint8_t> medium_at;
    std::vector<std::uint32_t> material_at;
    /// Where bodies touch or overlap; else the bodies around a walk are those that it has entered.
    std::optional<BodiesAt> bodies;
    ClearanceGrid clearance;
    float cell = 0;  ///< [m], of that grid
    /// Of each medium, balls that walks cross in one step; null or no entry: none.
    std::vector<std::shared_ptr<const BallBank>> balls;
    glm::vec3 low{0}, high{0};        ///< box around these bodies [m], a little wider
    std::uint32_t diffuse_after = 0;  ///< scatterings that leave nothing of a direction
    double mean_events = 0;           ///< of a walk that follows each, about; more than it needs
    /// More scatterings and reflections than any walk needs but one in thousands.
    std::uint32_t most_events = 0;
};

/// `inner`: materials whose bodies may lie inside or meet it (MaterialFacts::inner); each has a
/// medium. `grey`: the three bands coincide, in all these media. `meet`: surfaces of some of them
/// do; that faces of one material lie on one another is found. `scene` and `triangles` must outlive
/// the result.
WalkSpace make_walk_space(const formats::Scene& scene, const EmbreeScene& triangles,
                          std::uint32_t material, bool grey,
                          std::span<const std::uint32_t> inner = {}, bool meet = false);

/// The bodies of the space's media just below the surface of its own; that alone where edges hide
/// it. Precondition: WalkSpace::bodies.
MediumStack bodies_at_start(const WalkSpace& space, glm::vec3 point);

/// Number of the medium's shells around a point, counted along lines to infinity: every surface of
/// the medium that a line leaves through, less those that it enters through. 1 just inside a closed
/// body; 0 or less: the point lies outside, or the mesh has holes all around. A line through a hole
/// miscounts, so two lines must agree, the first of them along `direction`.
int count_shells(const WalkSpace& space, glm::vec3 point, glm::vec3 direction);

/// The mean free path [m] between effectively isotropic events, 1 / (sigma_t - g sigma_s), of the
/// densest band that scatters; 0: nothing scatters.
double transport_mean_free_path(const formats::Medium& medium);
/// The least of several media; 0: nothing scatters in any.
double shortest_transport_path(std::span<const formats::Medium* const> media);

}  // namespace opaline::bake
