#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/plan/effect.h"
#include "formats/opal/slots.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What the memory of a bake depends on.
struct MemoryCounts {
    formats::SceneCounts scene;
    double image_bytes = 0;       ///< of decoded textures
    double receivers = 0;         ///< vertices, or fewer where they share rows
    double translucent_rows = 0;  ///< of all receivers of media together
    double opaque_rows = 0;       ///< of all others
    double opaque_bands = 1;      ///< 3: some of these are coloured
    double media = 0;             ///< materials that are translucent
    double volume_bytes = 0;      ///< of volumes, baked with the knobs at hand
    double layer_bytes = 0;       ///< of cloud layers, likewise
    double light_bytes = 0;       ///< of light that goes from surface to surface
};

/// Of a scene of which only the size is known: everything counts as opaque, so that the prediction
/// is a lower bound.
MemoryCounts count_memory(const formats::SceneCounts& scene);
/// Of a loaded scene and its slots (shared_rows.h); parts that depend on the plan are left out.
MemoryCounts count_memory(const EffectTable& effects, const formats::Scene& scene,
                          const formats::SlotsView& slots, const Knobs& knobs);

/// Peak memory of a whole bake by part [bytes].
struct MemoryPrediction {
    struct Part {
        std::string name;
        double bytes = 0;
    };
    std::vector<Part> parts;

    double bytes() const;
    const Part& largest() const;
};

/// Predicts the peak resident memory of a bake from counts alone: allocates nothing that grows with
/// the scene. Good to a factor of two; meant to refuse what cannot fit before it is tried.
/// `threads` >= 1.
MemoryPrediction predict_memory(const EffectTable& effects, const MemoryCounts& counts,
                                const Knobs& knobs, unsigned threads);

}  // namespace opaline::bake
