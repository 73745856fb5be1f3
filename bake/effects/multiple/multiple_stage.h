#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/multiple/cluster_tree.h"
#include "bake/effects/multiple/medium_profile.h"
#include "bake/effects/multiple/sample_transport.h"
#include "bake/effects/multiple/walks/walk_stage.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// How light scattered many times is computed.
enum class MultipleModel : std::uint8_t {
    automatic,  ///< the dipole where its error fits, else walks
    dipole,     ///< every surface is a half space
    walks       ///< random walks in the true shape
};

/// Data of multiple scattering that all receivers of one medium share.
struct MultipleStage {
    MediumProfile medium;
    MultipleModel model = MultipleModel::dipole;  ///< not automatic
    GatherProfile profile;                        ///< of the medium, for these samples
    ClusterTree tree;                             ///< empty where walks need no dipole
    WalkStage walks;         ///< rows, or their difference to the dipole's where there is a tree
    std::uint64_t rays = 0;  ///< traced
};

struct MultipleOptions {
    std::uint32_t cubemap_size = 32;
    std::uint32_t samples = 60000;  ///< at most, or exactly
    bool exact_samples = false;
    double samples_per_path = 1;          ///< count_samples
    std::span<const BodyPoint> served{};  ///< where rows are asked for, and nowhere else
    double receivers = 0;      ///< as many as these or more: numbers of samples and sites follow it
    std::uint32_t kept = 128;  ///< coefficients of each sample
    std::uint64_t seed = 0;
    bool share_rays = true;   ///< between neighbouring samples
    std::uint32_t bands = 3;  ///< or 1, where those of the medium coincide
    MultipleModel model = MultipleModel::dipole;
    WalkBudget walks;
    double tolerance = 1e-3;  ///< GatherOptions, of the dipole at sites
    /// 4 or 9: walks also fill rows for the dependence on the view (SiteRows).
    std::uint32_t views = 1;
    bool all_orders = false;             ///< walks also count light that scatters once
    bool fills_crossed = false;          ///< as WalkOrders says
    std::vector<std::uint32_t> inner{};  ///< materials of other media inside, for walks
    bool layered = false;                ///< and these matter: the dipole cannot be used
    const OtherLight* light = nullptr;   ///< besides, or instead of, that of the environment
    bool meet = false;                   ///< surfaces of these media touch or overlap
    bool crosses_others = false;         ///< as WalkOrders says
};

/// Samples the surface of the material's medium with profile `medium`, traces the entering light,
/// and builds the tree. `rays`: the occluders; no ray is traced if it is empty. Incomplete if the
/// context is cancelled. Where the environment does not count, all columns are kept.
/// `bodies`: all triangles, for walks inside.
MultipleStage prepare_multiple(const formats::Scene& scene, const RayScene& rays,
                               const RayScene& bodies, std::uint32_t material,
                               const MediumProfile& medium, const MultipleOptions& options,
                               const Context& context);

}  // namespace opaline::bake
