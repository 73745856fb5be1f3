#include "bake/plan/predict_memory.h"

#include <algorithm>

#include "bake/plan/cost_model.h"

namespace opaline::bake {
namespace {

// Bytes, from the structs and from peaks of bakes of 3 000 to 200 000 triangles.
constexpr double kProgram = 40e6;           // code, libraries, test lights
constexpr double kThread = 4e6;             // its block of receivers, its stack
constexpr double kVertex = 12 + 12 + 8;     // of the scene: position, normal, texcoord
constexpr double kIndex = 4;                // of the scene
constexpr double kPrimitive = 32e3;         // names, a stage of the report, an Embree geometry
constexpr double kPlanTriangle = 200;       // edges and hulls while the scene is inspected
constexpr double kHierarchyTriangle = 200;  // Embree's, while it is built
constexpr double kReceiver = 150;           // vertex: receivers, body points, cells that weld them
constexpr double kSampleOverhead = 200;     // surface sample: itself, its place in the tree
constexpr double kEntry = 8;                // of a sample's vector: index and value
constexpr double kTree = 2;                 // nodes of the tree hold as much as the samples
constexpr double kGrowth = 2;               // rows are appended to vectors that double

constexpr double kTypicalTerms = 4;  // of a phase function that is not isotropic

}  // namespace

MemoryCounts count_memory(const formats::SceneCounts& scene) {
    MemoryCounts counts;
    counts.scene = scene;
    counts.opaque_rows = static_cast<double>(scene.vertices);
    return counts;
}

MemoryCounts count_memory(const formats::Scene& scene, const Knobs& knobs) {
    MemoryCounts counts;
    for (const formats::Material& material : scene.materials) {
        counts.media += material.medium ? 1 : 0;
    }
    for (const formats::Image8& image : scene.images) {
        counts.image_bytes += static_cast<double>(image.rgba.size());
    }
    for (const formats::Primitive& primitive : scene.primitives) {
        const auto vertices = static_cast<double>(primitive.position.size());
        ++counts.scene.primitives;
        counts.scene.vertices += primitive.position.size();
        counts.scene.indices += primitive.index.size();
        const auto& medium = scene.materials[primitive.material].medium;
        if (!medium) {
            counts.opaque_rows += vertices;
            continue;
        }
        using Type = formats::PhaseFunction::Type;
        const double terms = medium->phase.type == Type::isotropic ? 1
                             : knobs.phase_terms > 0 ? static_cast<double>(knobs.phase_terms)
                                                     : kTypicalTerms;
        counts.translucent_rows += vertices * (terms + (knobs.separate_terms ? 1 : 0));
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

MemoryPrediction predict_memory(const MemoryCounts& counts, const Knobs& knobs, unsigned threads) {
    const auto vertices = static_cast<double>(counts.scene.vertices),
               indices = static_cast<double>(counts.scene.indices),
               primitives = static_cast<double>(counts.scene.primitives), triangles = indices / 3;
    constexpr std::uint32_t kBands = 3;
    const auto opaque_row = static_cast<double>(row_bytes(knobs, false, 1));
    const auto translucent_row = static_cast<double>(row_bytes(knobs, true, kBands));
    const double samples = counts.media * knobs.samples;
    const double entries =
        std::min<double>(sample_coefficients(knobs), 6.0 * knobs.cubemap_size * knobs.cubemap_size);
    return {{{"the program", kProgram + kThread * threads},
             {"the scene", vertices * kVertex + indices * kIndex + counts.image_bytes},
             {"its primitives and instances", primitives * kPrimitive},
             {"the ray hierarchy", triangles * std::max(kPlanTriangle, kHierarchyTriangle)},
             {"receivers", vertices * kReceiver},
             {"surface samples", samples * (kSampleOverhead + kTree * entries * kEntry)},
             {"transport rows", kGrowth * (counts.opaque_rows * opaque_row +
                                           counts.translucent_rows * translucent_row)}}};
}

}  // namespace opaline::bake
