#include "bake/effects/multiple/multiple_stage.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bake/effects/multiple/gather_multiple.h"
#include "bake/effects/multiple/walks/walk_stage.h"
#include "bake/exchange/other_light.h"
#include "bake/physics/fresnel.h"
#include "bake/plan/knobs.h"
#include "bake/receivers/surface_samples.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// Entries of vectors of other light, which is smooth.
constexpr std::uint32_t kKeptOfLight = 32;

// Entries of a site's rows.
std::uint32_t kept_of(const MultipleOptions& options) {
    return has_environment(options.light) ? options.kept : kAllCoefficients;
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

// Light that enters through another body that walks leave by.
struct OtherBody {
    std::uint32_t material = 0;
    double eta = 1;
    std::vector<SurfaceSample> samples;
    SampleTransport transport;
};

// Not those that lie in or on another body.
void leave_out_hidden(const WalkSpace& space, std::vector<SurfaceSample>& samples) {
    if (!space.bodies) return;
    std::vector<SurfaceSample> seen;
    for (const SurfaceSample& s : samples) {
        const glm::vec3 before = s.position + 2 * space.bodies->touch() * s.geometric_normal;
        if (bodies_around(*space.bodies, space.place_of, before).empty()) seen.push_back(s);
    }
    if (!seen.empty()) {
        samples = std::move(seen);
    }
}

// As dense as those of the space's own material.
std::vector<OtherBody> light_others(const WalkSpace& space, const RayScene& rays, double per_sample,
                                    const MultipleOptions& options, const Context& context) {
    std::vector<OtherBody> others;
    if (!space.bodies) return others;
    const formats::Scene& scene = *space.scene;
    for (const std::uint32_t m : space.bodies->order()) {
        if (m == space.material || space.medium_of[m] == kNoWalkMedium) continue;
        std::vector<std::uint32_t> primitives;
        double area = 0;
        for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
            if (scene.primitives[p].material != m) continue;
            primitives.push_back(p);
            area += formats::surface_area(scene.primitives[p]);
        }
        constexpr double kFewest = 500;
        const double count = std::clamp(area / per_sample, kFewest,
                                        std::max(kFewest, static_cast<double>(options.samples)));
        OtherBody body{m,
                       static_cast<double>(scene.materials[m].medium->eta),
                       sample_surface(scene, primitives, static_cast<std::uint32_t>(count),
                                      options.seed, context),
                       {}};
        leave_out_hidden(space, body.samples);
        if (body.samples.empty()) continue;
        body.transport = bake_sample_transport(rays, body.samples,
                                               {options.cubemap_size, options.kept, body.eta,
                                                options.share_rays, options.light, kKeptOfLight},
                                               context);
        others.push_back(std::move(body));
    }
    return others;
}

ExitLight exit_light(const EnteringLight& entering, double eta, double escape,
                     const MultipleOptions& options) {
    return ExitLight(entering.samples, entering.rows,
                     ExitCells(entering.samples, options.cubemap_size, make_exit_lobe(eta)), escape,
                     options.light == nullptr ? nullptr : &entering.other);
}

void walk(const WalkSpace& space, const SitePlan& plan, const EnteringLight& entering,
          std::span<const OtherBody> others, double walks, const MultipleOptions& options,
          const Context& context, MultipleStage& stage) {
    ExitLight light = exit_light(entering, stage.medium.eta, stage.medium.exit, options);
    for (const OtherBody& body : others) {
        light.add_body(body.material,
                       exit_light({body.samples, body.transport.rows, body.transport.other},
                                  body.eta, 1 - fresnel_moments(body.eta).external, options));
    }
    const bool is_inside = !plan.is_residual && options.all_orders && space.media.size() == 1 &&
                           !space.media.front().field && !space.bodies;
    const WalkStageOptions wanted{
        .radius = plan.radius,
        .walks = walks,
        .is_inside = is_inside,
        .views = options.views,
        .served = options.served,
        .rows = {.cubemap_size = options.cubemap_size,
                 .kept = kept_of(options),
                 .bands = options.bands,
                 .seed = options.seed,
                 .orders = {options.all_orders ? 1u : 2u,
                            !options.all_orders && options.light != nullptr, options.fills_crossed,
                            options.crosses_others},
                 .counts_scattered = options.crosses_others}};
    std::vector<SurfaceSample> sites = place_sites(space, plan, options.seed, context);
    leave_out_hidden(space, sites);
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
    double depth = medium.smallest;
    if (options.layered && path > 0) {
        depth = depth > 0 ? std::min(depth, path) : path;
    }
    const std::uint32_t count =
        options.exact_samples
            ? options.samples
            : count_samples(area, depth,
                            {options.samples_per_path, static_cast<double>(options.samples),
                             options.receivers});
    std::vector<SurfaceSample> samples =
        sample_surface(scene, primitives, count, options.seed, context);
    const double per_sample = area / static_cast<double>(std::max<std::size_t>(1, samples.size()));
    stage.profile = make_gather_profile(stage.medium, std::sqrt(per_sample),
                                        diagonal_of(scene, std::nullopt), options.bands);
    const bool walks = options.model == MultipleModel::walks;
    stage.model = options.model;
    SitePlan plan;
    std::optional<WalkSpace> space;
    if (walks) {
        space.emplace(make_walk_space(scene, bodies.hierarchy(), material, options.bands == 1,
                                      options.inner, options.meet));
        leave_out_hidden(*space, samples);
        plan = plan_sites(area, diagonal_of(scene, material), path, options.walks);
        plan.is_residual = plan.is_residual && !options.layered;
        widen_for_receivers(plan, area, diagonal_of(scene, material), options.receivers);
    }
    const bool walks_alone = walks && !plan.is_residual;
    SeparateBodies apart;
    if (!walks_alone) {
        apart = SeparateBodies(scene, material);
        sort_by_body(apart, samples);
    }
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
            has_environment(options.light) ? kKeptOfLight : kAllCoefficients, std::move(apart));
        for (std::size_t b = 0; b < 3 && !walks; ++b) {  // walks hold the difference
            stage.tree.other_factor[b] = static_cast<float>(medium.all_orders[b]);
        }
    }
    if (walks && !context.cancelled()) {
        const double all_walks = count_walks(plan, area, options.walks);
        add_balls(*space, all_walks, options.seed, context);
        const std::vector<OtherBody> others =
            light_others(*space, rays, per_sample, options, context);
        const bool has_tree = !stage.tree.nodes.empty();
        walk(*space, plan,
             {samples, has_tree ? stage.tree.samples : light,
              has_tree ? stage.tree.other_samples : other},
             others, all_walks, options, context, stage);
    }
    return stage;
}

}  // namespace opaline::bake
