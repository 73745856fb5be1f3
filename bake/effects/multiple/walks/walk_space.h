#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/ball_bank.h"
#include "bake/effects/multiple/walks/walk_media.h"
#include "bake/transport/clearance_grid.h"
#include "bake/transport/embree_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

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
    ClearanceGrid clearance;
    float cell = 0;  ///< [m], of that grid
    /// Of each medium, balls that walks cross in one step; null or no entry: none.
    std::vector<std::shared_ptr<const BallBank>> balls;
    glm::vec3 low{0}, high{0};        ///< box around these bodies [m], a little wider
    std::uint32_t diffuse_after = 0;  ///< scatterings that leave nothing of a direction
    /// More scatterings and reflections than any walk needs but one in thousands.
    std::uint32_t most_events = 0;
};

/// `inner`: materials whose bodies may lie inside (MaterialFacts::inner); each has a medium.
/// `grey`: the three bands coincide, in all these media. `scene` and `triangles` must outlive the
/// result.
WalkSpace make_walk_space(const formats::Scene& scene, const EmbreeScene& triangles,
                          std::uint32_t material, bool grey,
                          std::span<const std::uint32_t> inner = {});

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
