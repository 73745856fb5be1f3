#include "bake/effects/multiple/multiple_stage.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/receivers/surface_samples.h"

namespace opaline::bake {
namespace {

double scene_diagonal(const formats::Scene& scene) {
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (const formats::Primitive& p : scene.primitives) {
        for (const glm::vec3 x : p.position) {
            low = glm::min(low, glm::dvec3(x));
            high = glm::max(high, glm::dvec3(x));
        }
    }
    return glm::length(high - low);
}

}  // namespace

MultipleStage prepare_multiple(const formats::Scene& scene, const RayScene& rays,
                               std::uint32_t material, const MediumProfile& medium,
                               const MultipleOptions& options, const Context& context) {
    std::vector<std::uint32_t> primitives;
    double area = 0;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        if (scene.primitives[p].material == material) {
            primitives.push_back(p);
            area += formats::surface_area(scene.primitives[p]);
        }
    }
    MultipleStage stage;
    stage.medium = medium;
    const std::uint32_t count =
        options.exact_samples
            ? options.samples
            : count_samples(area, stage.medium, options.samples_per_path, options.samples);
    const std::vector<SurfaceSample> samples =
        sample_surface(scene, primitives, count, options.seed, context);
    const double per_sample = area / static_cast<double>(std::max<std::size_t>(1, samples.size()));
    stage.profile = make_gather_profile(stage.medium, std::sqrt(per_sample), scene_diagonal(scene),
                                        options.bands);
    SampleTransport transport = bake_sample_transport(
        rays, samples, {options.cubemap_size, options.kept, stage.medium.eta, options.share_rays},
        context);
    stage.rays = transport.rays;
    if (!context.cancelled()) {
        stage.tree = build_cluster_tree(samples, std::move(transport), options.cubemap_size,
                                        options.kept, context);
    }
    return stage;
}

}  // namespace opaline::bake
