#include "bake/effects/multiple/walks/walk_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/effects/multiple/walks/inner_field.h"
#include "bake/receivers/surface_samples.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

bool is_same_phase(const PhaseTable& a, const PhaseTable& b) {
    return a.type == b.type && a.g == b.g && a.cosine == b.cosine;
}

// Of all bands.
double largest_of(const WalkSpace& space, const WalkMedium& medium) {
    const auto diagonal = static_cast<double>(glm::distance(space.low, space.high));
    double largest = 0;
    for (std::size_t group = 0; group < space.bands.size(); ++group) {
        const double size = diagonal * static_cast<double>(medium.sigma_t[group]);
        for (std::size_t b = 0; b < 3; ++b) {
            if (space.bands[group].member[b]) {
                const auto albedo = static_cast<double>(medium.albedo[b]);
                largest = std::max(largest, largest_ball(albedo, mean_cosine(medium.phase), size));
            }
        }
    }
    return largest;
}

// Cells of a mean free path, but not so small that the grid costs more than it saves.
void refine_grid(WalkSpace& space) {
    constexpr float kFinest = 1 / 400.0f;  // of the diagonal
    constexpr std::uint32_t kMostCells = 512;
    float densest = 0;
    for (const WalkMedium& medium : space.media) {
        densest = std::max({densest, medium.sigma_t[0], medium.sigma_t[1], medium.sigma_t[2]});
    }
    const float cell = std::max(1 / densest, kFinest * glm::distance(space.low, space.high));
    if (cell < space.cell) {
        space.cell = cell;
        space.clearance = ClearanceGrid(*space.scene, 0.5f * (space.low + space.high),
                                        0.5f * (space.high - space.low), cell, kMostCells);
    }
}

// Of sites on the surface.
void make_fields(const WalkSpace& space, std::span<const SurfaceSample> sites,
                 const WalkStageOptions& options, WalkStage& stage) {
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
}

// Whether points are so many that hardly a site is far from all of them.
bool covers_all(std::span<const BodyPoint> served, std::span<const SurfaceSample> sites,
                const WalkStage& stage) {
    constexpr double kOften = 4;  // that a site is read; e^-4 are not, where points are random
    double area = 0;
    for (const SurfaceSample& s : sites) {
        area += static_cast<double>(s.area);
    }
    const auto radius = static_cast<double>(stage.field.radius());
    return static_cast<double>(served.size()) * std::numbers::pi * radius * radius > kOften * area;
}

// Sites that add_walked_rows weighs for some of the points.
std::vector<std::uint8_t> find_read_sites(const WalkStage& stage, std::size_t sites,
                                          std::span<const BodyPoint> served) {
    std::vector<std::uint8_t> is_read(sites, 0);
    std::vector<SiteWeight> weights;
    const auto mark = [&](const SiteField& field, const BodyPoint& point, float tint) {
        field.weigh(point.position, point.normal, weights, tint);
        for (const SiteWeight& w : weights) {
            is_read[w.site] = 1;
        }
    };
    for (const BodyPoint& point : served) {
        mark(stage.field, point, stage.tint(point.position, point.normal));
        if (stage.view_field.size() > 0) {
            mark(stage.view_field, point, 1);
        }
    }
    return is_read;
}

}  // namespace

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

void widen_for_receivers(SitePlan& plan, double area, double diagonal, double receivers) {
    constexpr double kWidest = 0.1;     // of the diagonal
    constexpr double kPerReceiver = 2;  // sites
    constexpr double kPerSquare = 4;    // of the radius: a dozen sites within it
    if (!plan.is_residual || !(receivers > 0)) return;
    plan.radius = std::max(plan.radius, std::min(std::sqrt(area / receivers), kWidest * diagonal));
    const double sites =
        std::max(kPerReceiver * receivers, kPerSquare * area / (plan.radius * plan.radius));
    plan.sites = std::min(plan.sites, static_cast<std::uint32_t>(std::ceil(sites)));
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
    if (space.bands.empty() || sites.empty()) return stage;
    const std::vector<WalkStart> starts = options.is_inside
                                              ? make_inner_starts(space, sites, context)
                                              : make_walk_starts(space, sites, context);
    SiteRowOptions rows = options.rows;
    rows.views = options.is_inside ? 1 : options.views;
    const double runs = static_cast<double>(sites.size()) * static_cast<double>(space.bands.size());
    rows.walks_per_site =
        static_cast<std::uint32_t>(std::clamp(std::round(options.walks / runs), 1.0, 1e6));
    std::vector<std::uint8_t> is_read;
    if (!options.is_inside) {
        make_fields(space, sites, options, stage);
        if (!options.served.empty() && !covers_all(options.served, sites, stage)) {
            is_read = find_read_sites(stage, sites.size(), options.served);
        }
    }
    stage.rows =
        walk_from_sites(space, starts, light, rows, subtract, context, stage.counts, is_read);
    stage.view_fit = make_view_fit(static_cast<double>(space.eta));
    stage.orders = options.rows.orders;
    stage.seed = options.rows.seed;
    if (rows.counts_scattered) {
        stage.space = space;
    }
    if (options.is_inside) {
        const formats::Medium& medium = *space.scene->materials[space.material].medium;
        const double path = transport_mean_free_path(medium);
        const double radius = inner_radius({.radius = options.radius}, path);
        stage.inner = InnerField(starts, static_cast<float>(radius), static_cast<float>(path),
                                 formats::mean_cosine(medium.phase) == 0);
        stage.space = space;
        stage.fills_crossed = options.rows.orders.fills_crossed;
    }
    return stage;
}

float WalkStage::tint(glm::vec3 position, glm::vec3 normal) const {
    if (!medium) return 1;
    // Where light that is scattered few times turns back.
    constexpr std::array<float, 3> kDepths{0.1f, 0.4f, 1};
    glm::vec3 sum(0);
    for (const float share : kDepths) {
        sum += medium->color(position - share * depth * normal);
    }
    return glm::dot(sum, glm::vec3(0.2126f, 0.7152f, 0.0722f)) / kDepths.size();
}

namespace {

// What scatters at a point or meets other bodies, over what does at its sites, by band. Rows of
// `transmission` hold the rest of the point's own light, so that both are all of it.
glm::vec3 scale_to_own(const WalkStage& stage, const BodyPoint& point,
                       std::span<const SiteWeight> weights) {
    constexpr std::uint32_t kWalks = 64;
    constexpr float kMost = 4, kLeast = 0.02f;
    const WalkSpace& space = *stage.space;
    WalkStart start{point.inner, point.normal, point.normal,
                    std::max(1, count_shells(space, point.inner, -point.normal))};
    if (space.bodies) {
        start.around = bodies_at_start(space, point.inner);
    }
    start.vertex = point.position;
    WalkOrders orders = stage.orders;
    orders.is_straight_alone = true;
    WalkCounts counts;
    std::vector<WalkExit> exits;
    // The same of all points, so that neighbours differ by their light alone.
    std::uint32_t number = 0;
    for (WalkGroup group; group.flies_as < space.bands.size(); ++group.flies_as) {
        for (std::uint32_t w = 0; w < kWalks; ++w) {
            WalkRandom random({stage.seed, RandomStage::body_walk, 0x7fffffffu, number++}, true);
            follow_walk(space, group, start, orders, random, exits, counts);
        }
    }
    glm::vec3 scale(1);
    for (glm::length_t b = 0; b < 3; ++b) {
        const auto band = static_cast<std::size_t>(b);
        float of_sites = 0;
        for (const SiteWeight& w : weights) {
            of_sites += w.weight * stage.rows.scattered[w.site][band];
        }
        const auto own = static_cast<float>(counts.scattered_share(band));
        scale[b] = of_sites > kLeast ? std::min(kMost, own / of_sites) : 1;
    }
    return stage.rows.bands == 1 ? glm::vec3(scale.x) : scale;
}

}  // namespace

void add_walked_rows(const WalkStage& stage, const BodyPoint& point, float scale,
                     std::span<float> rgbx, std::span<float> views) {
    if (stage.rows.blocks.empty()) return;
    std::vector<SiteWeight> weights;
    stage.field.weigh(point.position, point.normal, weights,
                      stage.tint(point.position, point.normal));
    const glm::vec3 own = stage.rows.scattered.empty() || point.normal == glm::vec3(0)
                              ? glm::vec3(scale)
                              : scale * scale_to_own(stage, point, weights);
    for (const SiteWeight& w : weights) {
        add_site_row(stage.rows, w.site, 0, w.weight * own, rgbx);
    }
    if (views.empty()) return;
    stage.view_field.weigh(point.position, point.normal, weights);
    for (const SiteWeight& w : weights) {
        for (std::uint32_t k = 1; k < stage.rows.views; ++k) {
            add_site_row(stage.rows, w.site, k, w.weight * own,
                         views.subspan((k - 1) * rgbx.size(), rgbx.size()));
        }
    }
}

SiteRowSum sum_inner_rows(const WalkStage& stage, const BodyPoint& point, std::size_t texels,
                          std::uint32_t rows) {
    SiteRowSum sum(texels, rows, stage.rows.bands);
    if (point.normal == glm::vec3(0)) return sum;
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

double largest_ball(double albedo, double g, double size) {
    constexpr double kLeastSize = 200;  // walks in smaller bodies hardly ever have room
    constexpr double kPart = 1.0 / 8;
    constexpr double kReach = 2;  // diffusion lengths
    constexpr double kLeast = 5;  // smaller balls alone save no time
    const double lost = std::max(1e-9, (1 - albedo) * (1 - g * albedo));
    const double largest = std::min(kPart * size, kReach / std::sqrt(3 * lost));
    return size < kLeastSize || largest < kLeast ? 0 : largest;
}

void add_balls(WalkSpace& space, double walks, std::uint64_t seed, const Context& context) {
    // Events of a bank for each walk, which has tens or more, or a part of all that walks may have,
    // and a second or two in all.
    constexpr double kShare = 2, kPart = 0.01, kMostEvents = 5e7;
    constexpr double kJumpingPart = 0.1, kMostJumps = 1.5e7;
    const double expected = walks * space.mean_events;
    constexpr std::size_t kMostBanks = 8;  // of different phase functions
    space.balls.assign(space.media.size(), nullptr);
    std::vector<std::size_t> banked;
    for (std::size_t m = 0; m < space.media.size(); ++m) {
        const WalkMedium& medium = space.media[m];
        const double largest = medium.field ? 0 : largest_of(space, medium);
        if (!(largest > 0)) continue;
        const auto alike = std::ranges::find_if(banked, [&](std::size_t other) {
            return is_same_phase(space.media[other].phase, medium.phase);
        });
        if (alike != banked.end()) {
            space.balls[m] = space.balls[*alike];
            continue;
        }
        if (banked.size() == kMostBanks) continue;
        auto bank = std::make_shared<const BallBank>(make_ball_bank(
            medium.phase,
            {.largest = largest,
             .events = std::min(std::max(kShare * walks, kPart * expected), kMostEvents),
             .jumps = std::min(kJumpingPart * expected, kMostJumps),
             .seed = seed,
             .number = static_cast<std::uint32_t>(banked.size())},
            context));
        if (bank->radii() > 0) {
            space.balls[m] = std::move(bank);
            banked.push_back(m);
        }
    }
    if (!banked.empty()) {
        refine_grid(space);
    }
}

}  // namespace opaline::bake
