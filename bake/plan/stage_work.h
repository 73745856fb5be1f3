#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>

#include "bake/plan/knobs.h"
#include "bake/plan/row_layout.h"
#include "bake/scene/scene_facts.h"
#include "formats/scene.h"

namespace opaline::bake {

/// How long stages take on this machine over what counts and constants say, by kind of stage
/// (StageCost::kind). Predictions use it; decisions, and so files, do not.
struct StageRates {
    struct Learnt {
        double factor = 1;        ///< > 0: geometric mean over bakes, later ones count more
        std::uint32_t bakes = 0;  ///< that it was learnt from

        bool operator==(const Learnt&) const = default;
    };
    std::map<std::string, Learnt> kinds;

    /// Of a kind that no bake here had: the machine's speed, the geometric mean of all kinds; 1
    /// where nothing was learnt.
    double factor(const std::string& kind) const;
};

/// Seconds of one thread per unit of work as a function of the number of triangles: two values,
/// linear in log2 of the number (the depth of the hierarchy) between and beyond them.
struct CostBySize {
    static constexpr double kFew = 3072, kMany = 49152;  ///< triangles of the two values
    double few = 0, many = 0;

    /// `triangles` >= 0. Never less than a fraction of `few`, because a mesh of one triangle has a
    /// cost too.
    double at(double triangles) const {
        constexpr double kLeastShare = 0.25;
        const double place = std::log2(std::max(triangles, 1.0) / kFew) / std::log2(kMany / kFew);
        return std::max(few + place * (std::max(many, few) - few), kLeastShare * few);
    }
};

/// Work in seconds of one thread: the serial part and the parallel part.
struct Work {
    double alone = 0, shared = 0;

    Work& operator+=(const Work& other) {
        alone += other.alone;
        shared += other.shared;
        return *this;
    }
    Work operator-(const Work& other) const { return {alone - other.alone, shared - other.shared}; }
};

/// The inputs of all costs.
struct CostInput {
    const Knobs& knobs;
    double triangles = 0;  ///< of the scene
    double receivers = 0;  ///< of the scene
};

/// What the costs of one subject depend on.
struct SubjectCost {
    const CostInput& input;
    const formats::Material& material;
    const MaterialFacts& facts;
    const RowLayout& layout;
    double receivers = 0;  ///< that the work is for
    /// The scene has a ray hierarchy: truths trace even where rows do not.
    bool traces_rays = true;

    const formats::Medium& medium() const { return *material.medium; }
    /// The same at other knobs, with other rows.
    SubjectCost with(const CostInput& other, const RowLayout& rows) const {
        return {other, material, facts, rows, receivers, traces_rays};
    }
};

/// Memory for effects that gather many receivers together.
inline constexpr double kBatchBytes = 2147483648.0;

/// Seconds of one thread, of work that stages of several rooms do. These and those of single rooms
/// were measured once, on one core of a Xeon of 2023; what a machine and its scenes take over them
/// is learnt (StageRates).
inline constexpr CostBySize kCoherentRay{4.7e-8,
                                         7.7e-8};  ///< of a receiver's packets, cosine included
inline constexpr double kOpenCell = 1.8e-9;  ///< the cosine of such a ray's cell in an empty scene
inline constexpr double kEncodeGrey = 5.8e-9;  ///< transform, selection, quantising: texel of a row
inline constexpr double kGatherEntry = 3e-9;   ///< one entry of a sparse row into a receiver's row

/// Rays from one receiver to all texels: half of them lie below its horizon.
double count_rays(std::uint32_t cubemap_size);

/// Irradiance rows of `receivers`, dense.
Work irradiance_work(const CostInput& input, double receivers, bool occluded);
/// Irradiance at `cost.receivers` on the truths' cube map.
Work true_irradiance_work(const SubjectCost& cost);
/// Transform, selection and quantising.
Work encode_work(const CostInput& input, std::uint32_t rows, std::uint32_t bands, double receivers);
Work openness_work(const CostInput& input, double receivers, bool occluded);

/// Seconds of a random walk through a body: a flight and what ends it.
inline constexpr CostBySize kBodyEvent{2.4e-7, 2.8e-7};

/// The reflectance of a half space (even_light.h), all bands.
inline Work even_light_work() {
    constexpr double kBand = 2e-3;
    return {0, 3 * kBand};
}

}  // namespace opaline::bake
