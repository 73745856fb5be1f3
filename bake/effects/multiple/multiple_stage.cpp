#include "bake/effects/multiple/multiple_stage.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "bake/effects/multiple/gather_multiple.h"
#include "bake/effects/multiple/walks/walk_balls.h"
#include "bake/plan/knobs.h"
#include "bake/receivers/surface_samples.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// Entries of vectors of other light, which is smooth.
constexpr std::uint32_t kKeptOfLight = 32;

// Entries of a site's rows.
std::uint32_t kept_of(const MultipleOptions& options) {
    return OtherLight::has_environment(options.light) ? options.kept : kAllCoefficients;
}

// Of all materials or one.
double diagonal_of(const formats::Scene& scene, std::optional<std::uint32_t> material) {
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t v = 0;
             v < p.position.size() && p.material == material.value_or(p.material); ++v) {
            low = glm::min(low, glm::dvec3(p.position[v]));
            high = glm::max(high, glm::dvec3(p.position[v]));
        }
    }
    return glm::length(high - low);
}

// T_d as the dipole has it, times a factor per band; overwritten.
void gather_dipole_row(const MultipleStage& stage, glm::vec3 position, glm::vec3 normal,
                       double tolerance, glm::vec3 factor, std::uint32_t bands,
                       std::span<float> rgbx) {
    std::vector<ClusterWeight> weights;
    collect_weights(stage.tree, stage.profile, position, normal, {tolerance}, weights);
    if (factor != glm::vec3(1)) {
        for (ClusterWeight& w : weights) {
            for (std::size_t b = 0; b < 3; ++b) {
                w.weight[b] *= factor[static_cast<int>(b)];
            }
        }
    }
    if (bands == 1) {
        accumulate_grey(stage.tree, weights, rgbx);
    } else {
        accumulate(stage.tree, weights, rgbx);
    }
}

// Of the body's medium and, where they matter, of those inside [m].
double shortest_path(const formats::Scene& scene, std::uint32_t material,
                     const MultipleOptions& options) {
    std::vector<const formats::Medium*> media{&*scene.materials[material].medium};
    for (const std::uint32_t inner :
         options.layered ? options.inner : std::vector<std::uint32_t>{}) {
        media.push_back(&*scene.materials[inner].medium);
    }
    return shortest_transport_path(media);
}

// Light that enters through the samples.
struct EnteringLight {
    std::span<const SurfaceSample> samples;
    const SparseVectors& rows;
    const SparseVectors& other;
};

void walk(const WalkSpace& space, const SitePlan& plan, const EnteringLight& entering, double walks,
          const MultipleOptions& options, const Context& context, MultipleStage& stage) {
    const ExitLight light(
        entering.samples, entering.rows,
        ExitCells(entering.samples, options.cubemap_size, make_exit_lobe(stage.medium.eta)),
        stage.medium.exit, options.light == nullptr ? nullptr : &entering.other);
    const bool is_inside = !plan.is_residual && options.all_orders && space.media.size() == 1 &&
                           !space.media.front().field;
    const WalkStageOptions wanted{
        .radius = plan.radius,
        .walks = walks,
        .is_inside = is_inside,
        .views = options.views,
        .rows = {
            .cubemap_size = options.cubemap_size,
            .kept = kept_of(options),
            .bands = options.bands,
            .seed = options.seed,
            .orders = {options.all_orders ? 1u : 2u,
                       !options.all_orders && options.light != nullptr, options.fills_crossed}}};
    const std::vector<SurfaceSample> sites = place_sites(space, plan, options.seed, context);
    const glm::vec3 scale(static_cast<float>(1 / (std::numbers::pi * stage.medium.exit)));
    std::function<void(std::size_t, std::span<float>)> subtract;
    if (!stage.tree.nodes.empty()) {
        subtract = [&](std::size_t s, std::span<float> row) {
            std::vector<float> dipole(row.size());
            gather_dipole_row(stage, sites[s].position, sites[s].normal, options.tolerance, scale,
                              options.bands, dipole);
            for (std::size_t k = 0; k < dipole.size(); ++k) {
                row[k] -= dipole[k];
            }
        };
    }
    stage.walks = take_walks(space, light, sites, wanted, subtract, context);
    stage.rays += stage.walks.counts.rays;
}

}  // namespace

MultipleStage prepare_multiple(const formats::Scene& scene, const RayScene& rays,
                               const RayScene& bodies, std::uint32_t material,
                               const MediumProfile& medium, const MultipleOptions& options,
                               const Context& context) {
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
    const double path = shortest_path(scene, material, options);
    MediumProfile finest = medium;
    if (options.layered && path > 0) {
        finest.smallest = medium.smallest > 0 ? std::min(medium.smallest, path) : path;
    }
    const std::uint32_t count =
        options.exact_samples
            ? options.samples
            : count_samples(area, finest, options.samples_per_path, options.samples);
    const std::vector<SurfaceSample> samples =
        sample_surface(scene, primitives, count, options.seed, context);
    const double per_sample = area / static_cast<double>(std::max<std::size_t>(1, samples.size()));
    stage.profile = make_gather_profile(stage.medium, std::sqrt(per_sample),
                                        diagonal_of(scene, std::nullopt), options.bands);
    const bool walks = options.model == MultipleModel::walks;
    stage.model = options.model;
    SitePlan plan;
    if (walks) {
        plan = plan_sites(area, diagonal_of(scene, material), path, options.walks);
        plan.is_residual = plan.is_residual && !options.layered;
    }
    const bool walks_alone = walks && !plan.is_residual;
    SampleTransport transport =
        bake_sample_transport(rays, samples,
                              {options.cubemap_size, options.kept, stage.medium.eta,
                               options.share_rays, options.light, kKeptOfLight},
                              context);
    stage.rays = transport.rays;
    SparseVectors light, other;
    if (walks_alone) {
        light = std::move(transport.rows);
        other = std::move(transport.other);
    } else if (!context.cancelled()) {
        stage.tree = build_cluster_tree(
            samples, std::move(transport), options.cubemap_size, options.kept, context,
            OtherLight::has_environment(options.light) ? kKeptOfLight : kAllCoefficients);
    }
    if (walks && !context.cancelled()) {
        const double all_walks = count_walks(plan, area, options.walks);
        WalkSpace space =
            make_walk_space(scene, bodies.hierarchy(), material, options.bands == 1, options.inner);
        add_balls(space, all_walks, options.seed, context);
        const bool has_tree = !stage.tree.nodes.empty();
        walk(space, plan,
             {samples, has_tree ? stage.tree.samples : light,
              has_tree ? stage.tree.other_samples : other},
             all_walks, options, context, stage);
    }
    return stage;
}

void gather_multiple_rows(const MultipleStage& stage, const BodyPoint& point, double tolerance,
                          std::uint32_t bands, std::span<float> rgbx, std::span<float> views) {
    if (stage.tree.nodes.empty()) {
        std::ranges::fill(rgbx, 0.0f);
    } else {
        gather_dipole_row(stage, point.position, point.normal, tolerance, glm::vec3(1), bands,
                          rgbx);
    }
    std::ranges::fill(views, 0.0f);
    if (stage.model == MultipleModel::walks) {
        // A walked row is T_d / (pi c_exit).
        add_walked_rows(stage.walks, point,
                        static_cast<float>(std::numbers::pi * stage.medium.exit), rgbx, views);
    }
}

}  // namespace opaline::bake
