#pragma once

#include <cstdint>

#include "bake/plan/bake_plan.h"
#include "bake/plan/rates.h"
#include "bake/plan/row_layout.h"
#include "bake/plan/scene_facts.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Work in seconds of one thread: what one thread alone must do, and what all share.
struct Work {
    double alone = 0, shared = 0;

    Work& operator+=(const Work& other) {
        alone += other.alone;
        shared += other.shared;
        return *this;
    }
};

/// What all costs depend on.
struct CostInput {
    const Rates& rates;
    const Knobs& knobs;
    double triangles = 0;  ///< of the scene
    double receivers = 0;  ///< of the scene
};

/// How closely a receiver of a medium is looked at for the truth.
struct TruthEffort {
    double points = 1024;      ///< of the surface integral, for each of two estimates
    double depth_samples = 8;  ///< of single scattering
};

/// Rays from one receiver to all texels: half of them lie below its horizon.
double count_rays(std::uint32_t cubemap_size);

/// Events of a random walk that enters a half space with uniform light (half_space_walk.h):
/// fitted to walks, good to 1.3. `albedo` in [0, 1], `g`: mean cosine, `eta`: relative index.
double count_walk_events(double albedo, double g, double eta);

/// Samples that the surface of a medium gets.
double expected_samples(const formats::Medium& medium, double area, const Knobs& knobs);

/// Nodes and samples that a gather on average takes for a receiver: where the profile changes over
/// a patch by what `knobs.tolerance` allows, the patch is one.
double count_weights(const formats::Medium& medium, const MaterialFacts& facts, double samples,
                     double tolerance);

/// Work of the stages. Of one material, primitive or scene, as the name says.
/// `occluded`: RowLayout::occluded, whether rays are traced.
Work direct_rows_work(const CostInput& input, double receivers, bool occluded);
Work albedo_work(const CostInput& input, const formats::Medium& medium);
Work profile_work(const CostInput& input, const formats::Medium& medium);
Work samples_work(const CostInput& input, const formats::Medium& medium, const MaterialFacts& facts,
                  bool occluded);
Work multiple_rows_work(const CostInput& input, const formats::Medium& medium,
                        const MaterialFacts& facts, std::uint32_t bands, double receivers);
Work light_maps_work(const CostInput& input, const MaterialFacts& facts);
Work single_rows_work(const CostInput& input, const MaterialFacts& facts, std::uint32_t terms,
                      std::uint32_t bands, double receivers);
Work encode_work(const CostInput& input, std::uint32_t rows, std::uint32_t bands, double receivers);
Work openness_work(const CostInput& input, double glossy_receivers, bool occluded);
Work direct_check_work(const CostInput& input, double checked, bool occluded);
Work medium_check_work(const CostInput& input, const MaterialFacts& facts, const RowLayout& layout,
                       double checked, const TruthEffort& effort);

}  // namespace opaline::bake
