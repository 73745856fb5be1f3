#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/multiple/gather_profile.h"
#include "bake/transport/cluster_tree.h"
#include "bake/transport/ray_scene.h"
#include "bake/transport/sample_transport.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Data of multiple scattering that all receivers of one medium share.
struct MultipleStage {
    MediumProfile medium;
    GatherProfile profile;  ///< of the medium, for these samples
    ClusterTree tree;
    std::uint64_t rays = 0;  ///< traced
};

struct MultipleOptions {
    std::uint32_t cubemap_size = 32;
    std::uint32_t samples = 60000;  ///< at most, or exactly
    bool exact_samples = false;
    double samples_per_path = 1;  ///< count_samples
    std::uint32_t kept = 128;     ///< coefficients of each sample
    std::uint64_t seed = 0;
    bool share_rays = true;   ///< between neighbouring samples
    std::uint32_t bands = 3;  ///< or 1, where those of the medium coincide
};

/// Samples the surface of the material's medium with profile `medium`, traces the entering light,
/// and builds the tree. `rays`: the occluders; no ray is traced if it is empty. Incomplete if the
/// context is cancelled.
MultipleStage prepare_multiple(const formats::Scene& scene, const RayScene& rays,
                               std::uint32_t material, const MediumProfile& medium,
                               const MultipleOptions& options, const Context& context);

}  // namespace opaline::bake
