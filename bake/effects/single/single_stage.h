#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/single/light_maps.h"
#include "bake/effects/single/ray_single.h"
#include "bake/plan/dense_rows.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Data of single scattering that all receivers of one medium share.
struct SingleStage {
    SingleMedium medium;
    DirectionSet directions;  ///< of a cube map as large as the asset's, or smaller
    bool by_rays = false;     ///< every receiver exactly; otherwise by light maps
    BodyMesh mesh;            ///< of light maps
    std::uint32_t view_size = 0;
};

struct SingleOptions {
    std::uint32_t cubemap_size = 32;
    std::uint32_t depth_samples = 8;
    std::uint32_t terms = 1;  ///< of the phase function: 1, 4, 9, 16 or 25
    bool by_rays = false;
    std::uint32_t bands = 3;  ///< or 1, where those of the medium coincide
};

SingleStage prepare_single(const formats::Scene& scene, const RayScene& rays,
                           std::uint32_t material, const SingleOptions& options,
                           const Context& context);

/// T_k of some receivers.
struct SingleBatch {
    SingleRows rows;           ///< by light maps, or
    std::vector<float> dense;  ///< by rays: [receiver][term][band][texel]
    std::size_t row_size = 0;  ///< bands K 6 n n
};

/// Receivers whose rows fit into `bytes`; at least 1.
std::size_t receivers_per_batch(const SingleStage& stage, std::size_t bytes);
SingleBatch gather_single_batch(const SingleStage& stage, const RayScene& rays,
                                std::span<const BodyPoint> points, const Context& context);
/// The row of one receiver: terms, in each the bands, in each the texels. `row`:
/// batch.row_size values. Any thread may read.
void read_single(const SingleBatch& batch, std::size_t receiver, std::span<float> row);
/// Adds the transform of that row, gathered on a cube map of size m, to rows `first` and on of a
/// dense row of a cube map at least as large.
void add_single(const SingleBatch& batch, std::size_t receiver, std::uint32_t m,
                std::uint32_t first, const DenseRow& row);

}  // namespace opaline::bake
