#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/effects/multiple/cluster_tree.h"
#include "bake/effects/multiple/medium_profile.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/plan/dense_rows.h"
#include "bake/plan/row_layout.h"

namespace opaline::bake {

/// Weight of one node or sample in a receiver's sum, per band [1/m^2]; 0 in bands that the profile
/// lacks.
struct ClusterWeight {
    std::uint32_t id = 0;  ///< a node, or nodes + sample
    std::array<float, 3> weight{};
};

struct GatherOptions {
    /// A node is used as a whole where the norm of its sum times the variation of R_far over its
    /// box is at most `tolerance` R ||E|| (multiple/README.md, "Hierarchy"). 0: every sample.
    double tolerance = 1e-3;
};

/// The weights of T_d(x) = sum A_i R_far(|x_i - x|) E_i + near_mass mean E at a point with unit
/// normal. The mean is over nearby samples that face the same way, so the two sides of a thin part
/// do not mix. Samples of other bodies than the point's do not count. With dense samples near_mass
/// is 0. Overwrites `weights`.
void collect_weights(const ClusterTree& tree, const GatherProfile& profile, glm::vec3 position,
                     glm::vec3 normal, const GatherOptions& options,
                     std::vector<ClusterWeight>& weights);

/// Sum of weight times vector: the Haar vector of T_d in three bands, interleaved as RGBx, 4 * 6 n
/// n values, overwritten.
void accumulate(const ClusterTree& tree, std::span<const ClusterWeight> weights,
                std::span<float> rgbx);
/// The same for the first band only, 6 n n values.
void accumulate_grey(const ClusterTree& tree, std::span<const ClusterWeight> weights,
                     std::span<float> sums);

/// T_d of the stage's dipole at a point, times a factor per band: four floats per texel (one with
/// one band), overwritten. Precondition: the stage has a tree.
void gather_dipole_row(const MultipleStage& stage, glm::vec3 position, glm::vec3 normal,
                       double tolerance, glm::vec3 factor, std::uint32_t bands,
                       std::span<float> rgbx);

/// T_0 += T_d / (pi c_exit h_0). Where the layout has rows by view, adds the walked light to them
/// as harmonics of the view w'. `tolerance` of the gather; `layout` and `row` of the stage's
/// material.
void add_multiple_rows(const MultipleStage& stage, const BodyPoint& point, double tolerance,
                       const RowLayout& layout, const DenseRow& row);

}  // namespace opaline::bake
