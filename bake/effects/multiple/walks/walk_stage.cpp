#include "bake/effects/multiple/walks/walk_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/effects/multiple/walks/inner_sites.h"
#include "bake/receivers/surface_samples.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {

SitePlan plan_sites(double area, double diagonal, double mean_free_path, const WalkBudget& budget) {
    // In mean free paths, but not wider than the body's own features, unless walks are too few for
    // that (RESULTS.md, "Walks").
    constexpr double kRadius = 1.5, kWide = 0.03, kWidest = 0.05;
    constexpr double kSpacing = 0.3, kFewestSites = 500;
    constexpr double kLeastRadius = 1.8;  // spacings: ten sites
    const double widest = kWidest * diagonal;
    const double carried = std::min(kRadius * mean_free_path, widest);
    const double for_walks =
        std::sqrt(budget.around * area / (std::numbers::pi * std::max(budget.most, 1.0)));
    const double radius =
        std::max(std::min(carried, kWide * diagonal), std::min(for_walks, widest));
    const double spacing = kSpacing * radius;
    const double count = std::clamp(area / (spacing * spacing), kFewestSites,
                                    std::max(kFewestSites, static_cast<double>(budget.sites)));
    SitePlan plan;
    plan.sites = static_cast<std::uint32_t>(count);
    plan.radius = std::max(radius, kLeastRadius * std::sqrt(area / count));
    plan.is_residual = plan.radius > 1.5 * carried;
    return plan;
}

double count_walks(const SitePlan& plan, double area, const WalkBudget& budget) {
    const double part = std::numbers::pi * plan.radius * plan.radius;
    return part > 0 ? std::min(budget.most, budget.around * std::max(1.0, area / part))
                    : budget.most;
}

// Light inside varies over mean free paths, whatever the surface (README.md, "From sites to
// receivers"). A wider fit has less noise and costs more.
double inner_radius(const SitePlan& plan, double mean_free_path) {
    constexpr double kWider = 2, kWidest = 3, kPaths = 2;
    return std::clamp(kPaths * mean_free_path, kWider * plan.radius, kWidest * plan.radius);
}

std::vector<SurfaceSample> place_sites(const WalkSpace& space, const SitePlan& plan,
                                       std::uint64_t seed, const Context& context) {
    std::vector<std::uint32_t> primitives;
    for (std::uint32_t p = 0; p < space.scene->primitives.size(); ++p) {
        if (space.scene->primitives[p].material == space.material) {
            primitives.push_back(p);
        }
    }
    // Of another seed than the samples.
    return sample_surface(*space.scene, primitives, plan.sites, ~seed, context);
}

WalkStage take_walks(const WalkSpace& space, const ExitLight& light,
                     std::span<const SurfaceSample> sites, const WalkStageOptions& options,
                     const std::function<void(std::size_t, std::span<float>)>& subtract,
                     const Context& context) {
    WalkStage stage;
    if (space.bands.empty() || sites.empty()) {
        return stage;
    }
    const std::vector<WalkStart> starts = options.is_inside
                                              ? make_inner_starts(space, sites, context)
                                              : make_walk_starts(space, sites, context);
    SiteRowOptions rows = options.rows;
    rows.views = options.is_inside ? 1 : options.views;
    const double runs = static_cast<double>(sites.size()) * static_cast<double>(space.bands.size());
    rows.walks_per_site =
        static_cast<std::uint32_t>(std::clamp(std::round(options.walks / runs), 1.0, 1e6));
    stage.rows = walk_from_sites(space, starts, light, rows, subtract, context, stage.counts);
    stage.view_fit = make_view_fit(static_cast<double>(space.eta));
    if (options.is_inside) {
        const formats::Medium& medium = *space.scene->materials[space.material].medium;
        const double path = transport_mean_free_path(medium);
        const double radius = inner_radius({.radius = options.radius}, path);
        stage.inner = InnerField(starts, static_cast<float>(radius), static_cast<float>(path),
                                 formats::mean_cosine(medium.phase) == 0);
        stage.space = space;
        stage.fills_crossed = options.rows.orders.fills_crossed;
        return stage;
    }
    std::vector<float> tints;
    if (space.media.front().field) {
        stage.medium = space.media.front().field;
        stage.depth = static_cast<float>(
            transport_mean_free_path(*space.scene->materials[space.material].medium));
        for (const SurfaceSample& s : sites) {
            tints.push_back(stage.tint(s.position, s.normal));
        }
    }
    stage.field = SiteField(sites, static_cast<float>(options.radius), std::move(tints));
    if (options.views > 1) {
        constexpr double kWider = 2;
        stage.view_field = SiteField(sites, static_cast<float>(kWider * options.radius));
    }
    return stage;
}

float WalkStage::tint(glm::vec3 position, glm::vec3 normal) const {
    if (!medium) {
        return 1;
    }
    // Where light that is scattered few times turns back.
    constexpr std::array<float, 3> kDepths{0.1f, 0.4f, 1};
    glm::vec3 sum(0);
    for (const float share : kDepths) {
        sum += medium->color(position - share * depth * normal);
    }
    return glm::dot(sum, glm::vec3(0.2126f, 0.7152f, 0.0722f)) / kDepths.size();
}

void add_walked_rows(const WalkStage& stage, const BodyPoint& point, float scale,
                     std::span<float> rgbx, std::span<float> views) {
    if (stage.rows.blocks.empty()) {
        return;
    }
    std::vector<SiteWeight> weights;
    stage.field.weigh(point.position, point.normal, weights,
                      stage.tint(point.position, point.normal));
    for (const SiteWeight& w : weights) {
        add_site_row(stage.rows, w.site, 0, glm::vec3(scale * w.weight), rgbx);
    }
    if (views.empty()) {
        return;
    }
    stage.view_field.weigh(point.position, point.normal, weights);
    for (const SiteWeight& w : weights) {
        for (std::uint32_t k = 1; k < stage.rows.views; ++k) {
            add_site_row(stage.rows, w.site, k, glm::vec3(scale * w.weight),
                         views.subspan((k - 1) * rgbx.size(), rgbx.size()));
        }
    }
}

SiteRowSum sum_inner_rows(const WalkStage& stage, const BodyPoint& point, std::size_t texels,
                          std::uint32_t rows) {
    SiteRowSum sum(texels, rows, stage.rows.bands);
    if (point.normal == glm::vec3(0)) {
        return sum;
    }
    const WalkSpace& space = *stage.space;
    const ViewSet seen =
        make_view_set(stage.view_fit, static_cast<double>(space.eta), point.normal, rows);
    const FirstFlight flight = trace_first_flight(space, seen, point, stage.fills_crossed);
    std::vector<InnerWeight> weights;
    stage.inner.weigh(space, point, seen, flight, rows, weights);
    for (const InnerWeight& w : weights) {
        SiteRowSum::Weights by_band{};
        for (std::uint32_t r = 0; r < rows; ++r) {
            for (std::size_t g = 0; g < space.bands.size(); ++g) {
                for (std::size_t b = 0; b < 3; ++b) {
                    if (space.bands[g].member[b]) {
                        by_band[r][b] = w.row[r][g];
                    }
                }
            }
        }
        sum.add(stage.rows, w.site, by_band);
    }
    return sum;
}

}  // namespace opaline::bake
