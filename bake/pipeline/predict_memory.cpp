#include "bake/pipeline/predict_memory.h"

#include <algorithm>

#include "bake/effects/layers/layer_work.h"
#include "bake/effects/volumes/volume_parts.h"
#include "bake/effects/volumes/volume_work.h"
#include "bake/pipeline/cost_model.h"
#include "bake/scene/shared_rows.h"

namespace opaline::bake {
namespace {

// Bytes, from the structs and from peaks of bakes of 3 000 to 200 000 triangles.
constexpr double kProgram = 40e6;           // code, libraries, test lights
constexpr double kThread = 4e6;             // its block of receivers, its stack
constexpr double kVertex = 12 + 12 + 8;     // of the scene: position, normal, texcoord
constexpr double kIndex = 4;                // of the scene
constexpr double kPrimitive = 32e3;         // names, a stage of the report, an Embree geometry
constexpr double kPlanTriangleBytes = 200;  // edges and hulls while the scene is inspected
constexpr double kHierarchyTriangle = 200;  // Embree's, while it is built
constexpr double kReceiver = 150;           // vertex: receivers, body points, cells that weld them
// Rows are appended to vectors that double; those of a primitive have twice as many coefficients
// before they are shared (encode/share_rows.h).
constexpr double kGrowth = 3;

}  // namespace

MemoryCounts count_memory(const formats::SceneCounts& scene) {
    MemoryCounts counts;
    counts.scene = scene;
    // Vertices may share rows. In a closed mesh six triangles meet at one, in the mean.
    counts.receivers =
        std::min(static_cast<double>(scene.vertices), static_cast<double>(scene.indices) / 6);
    counts.opaque_rows = counts.receivers;
    return counts;
}

MemoryCounts count_memory(const EffectTable& effects, const formats::Scene& scene,
                          const formats::SlotsView& slots, const Knobs& knobs) {
    MemoryCounts counts;
    for (const formats::Material& material : scene.materials) {
        counts.media += material.medium ? 1 : 0;
    }
    for (const formats::Image8& image : scene.images) {
        counts.image_bytes += static_cast<double>(image.rgba.size());
    }
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const formats::Primitive& primitive = scene.primitives[p];
        const double receivers = count_receivers_of(scene, slots, p);
        counts.receivers += receivers;
        ++counts.scene.primitives;
        counts.scene.vertices += primitive.position.size();
        counts.scene.indices += primitive.index.size();
        const formats::Material& material = scene.materials[primitive.material];
        const auto& medium = material.medium;
        if (material.sheet) {
            counts.translucent_rows += 2 * receivers;
            continue;
        }
        if (!medium) {
            counts.opaque_rows += receivers;
            continue;
        }
        double terms = 1;
        for (const EffectDescriptor& effect : effects.effects) {
            if (effect.gather.typical_rows != nullptr) {
                terms = std::max(terms, effect.gather.typical_rows(*medium, knobs));
            }
        }
        counts.translucent_rows += receivers * (terms + (knobs.separate_terms ? 1 : 0));
    }
    const auto [parted, layouts] = part_volumes(scene, plan_volumes(scene, knobs).layouts, knobs);
    const std::vector<VolumeWork> works =
        count_volume_work(parted ? *parted : scene, layouts, knobs);
    for (const VolumeWork& work : works) {
        counts.volume_bytes += volume_memory(work, knobs);
    }
    if (sees_surfaces(layouts)) {
        counts.volume_bytes += seen_surfaces_memory(works, knobs);
    }
    for (const formats::CloudLayer& layer : scene.layers) {
        counts.layer_bytes += layer_memory(layer, knobs);
    }
    return counts;
}

double MemoryPrediction::bytes() const {
    double sum = 0;
    for (const Part& part : parts) {
        sum += part.bytes;
    }
    return sum;
}

const MemoryPrediction::Part& MemoryPrediction::largest() const {
    return *std::max_element(parts.begin(), parts.end(),
                             [](const Part& a, const Part& b) { return a.bytes < b.bytes; });
}

MemoryPrediction predict_memory(const EffectTable& effects, const MemoryCounts& counts,
                                const Knobs& knobs, unsigned threads) {
    const auto vertices = static_cast<double>(counts.scene.vertices),
               indices = static_cast<double>(counts.scene.indices),
               primitives = static_cast<double>(counts.scene.primitives), triangles = indices / 3;
    constexpr std::uint32_t kBands = 3;
    const auto opaque_row = static_cast<double>(
        row_bytes(knobs, false, static_cast<std::uint64_t>(counts.opaque_bands)));
    const auto translucent_row = static_cast<double>(row_bytes(knobs, true, kBands));
    double samples = 0;  // of one medium
    for (const EffectDescriptor& effect : effects.effects) {
        samples += effect.samples.bytes != nullptr ? effect.samples.bytes(knobs) : 0;
    }
    return {{{"the program", kProgram + kThread * threads},
             {"the scene", vertices * kVertex + indices * kIndex + counts.image_bytes},
             {"its primitives and instances", primitives * kPrimitive},
             {"the ray hierarchy", triangles * std::max(kPlanTriangleBytes, kHierarchyTriangle)},
             {"receivers", counts.receivers * kReceiver},
             {"surface samples", counts.media * samples},
             {"volumes", counts.volume_bytes},
             {"cloud layers", counts.layer_bytes},
             {"light from surface to surface", counts.light_bytes},
             {"transport rows", kGrowth * (counts.opaque_rows * opaque_row +
                                           counts.translucent_rows * translucent_row)}}};
}

}  // namespace opaline::bake
