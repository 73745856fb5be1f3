#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "bake/effects/multiple/walks/phase_table.h"
#include "bake/scene/medium_field.h"
#include "bake/transport/clearance_grid.h"
#include "bake/transport/embree_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Bands of a medium with the same extinction: light of each flies alike. Other bands have albedo
/// 0.
struct WalkBands {
    float sigma_t = 0;  ///< [1/m] > 0
    std::array<float, 3> albedo{};
    std::array<bool, 3> member{};
};

/// A body and its medium, ready for random walks. Bands hold the stated coefficients; `field` says
/// how much less of them there is at a point.
struct WalkSpace {
    const formats::Scene* scene = nullptr;
    const EmbreeScene* triangles = nullptr;  ///< of the whole scene
    std::uint32_t material = 0;
    float eta = 1;
    bool is_grey = false;  ///< the first band stands for all three
    PhaseTable phase;
    std::vector<WalkBands> bands;      ///< 1 to 3; empty: nothing scatters
    std::optional<MediumField> field;  ///< none: the medium is homogeneous
    ClearanceGrid clearance;
    glm::vec3 low{0}, high{0};        ///< box around the body [m], a little wider
    std::uint32_t diffuse_after = 0;  ///< scatterings that leave nothing of a direction
    /// More scatterings and reflections than any walk needs but one in thousands.
    std::uint32_t most_events = 0;
};

/// `grey`: the three bands coincide. `scene` and `triangles` must outlive the result.
WalkSpace make_walk_space(const formats::Scene& scene, const EmbreeScene& triangles,
                          std::uint32_t material, bool grey);

/// Number of the medium's shells around a point, counted along lines to infinity: every surface of
/// the medium that a line leaves through, less those that it enters through. 1 just inside a closed
/// body; 0 or less: the point lies outside, or the mesh has holes all around. A line through a hole
/// miscounts: the answer is what two lines agree on, the first of them along `direction`.
int count_shells(const WalkSpace& space, glm::vec3 point, glm::vec3 direction);

/// The mean free path [m] between effectively isotropic events, 1 / (sigma_t - g sigma_s), of the
/// densest band that scatters; 0: nothing scatters.
double transport_mean_free_path(const formats::Medium& medium);

}  // namespace opaline::bake
