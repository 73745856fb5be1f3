#include "bake/effects/transmission/transmission.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/base/frame.h"
#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/effects/transmission/rules_transmission.h"
#include "bake/effects/transmission/straight_paths.h"
#include "bake/effects/transmission/straight_rows.h"
#include "bake/effects/transmission/view_fit.h"
#include "bake/exchange/other_light.h"
#include "bake/lights/luminance.h"
#include "bake/lights/true_irradiance.h"
#include "bake/physics/fresnel.h"
#include "bake/plan/stage_work.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// What random views of a receiver see of the published lights.
struct StraightTruth {
    std::span<const TestLight> lights;
    SmoothLights smooth;
    std::uint32_t views = 0;  //< for each of the two estimates
    std::uint32_t terms = 1;  //< harmonics of the view
    // What surfaces send that stand before the sky; none: they are black.
    std::optional<BounceTruth> surfaces{};
};

constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};
constexpr double kSpreadAs = 256;  // views: 5 degrees
// Tells the keys of paths from surfaces apart from those of receivers.
constexpr std::uint64_t kOfViews = std::uint64_t{1} << 63;

double luminance_of(const StraightExit& exit, std::uint32_t bands) {
    double sum = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        sum += kLuminance[b] * static_cast<double>(exit.weight[bands == 1 ? 0 : b]);
    }
    return sum;
}

// Unit, within the cone of that cosine around an axis, evenly.
glm::vec3 random_around(glm::vec3 axis, double cosine, float u, float v) {
    const double c = 1 - (1 - cosine) * static_cast<double>(u), sine = std::sqrt(1 - c * c);
    const double azimuth = 2 * std::numbers::pi * static_cast<double>(v);
    return make_frame(axis).to_world(
        glm::vec3(glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), c)));
}

void add_light(const StraightTruth& truth, glm::vec3 direction, double weight,
               const std::array<float, 4>& u, Luminance& sum) {
    const double cosine = spread_cosine(kSpreadAs);
    const double solid_angle = 2 * std::numbers::pi * (1 - cosine);
    const float* const radiance =
        truth.smooth.towards(random_around(direction, cosine, u[2], u[3]));
    for (std::size_t l = 0; l < truth.lights.size(); ++l) {
        sum[l] += weight * static_cast<double>(radiance[l]);
        for (const TestDisc& disc : truth.lights[l].discs) {
            if (static_cast<double>(glm::dot(direction, disc.direction)) > cosine) {
                sum[l] += weight * disc.flux / solid_angle;
            }
        }
    }
}

// The same of a surface, by one path. `number`: of the exit.
std::uint64_t add_surface(const StraightTruth& truth, const StraightExit& exit, std::uint32_t bands,
                          double weight, std::uint64_t key, std::uint32_t number, Luminance& sum) {
    Luminance seen(sum.size());
    const formats::Rgb share{exit.weight[0], exit.weight[bands == 1 ? 0 : 1],
                             exit.weight[bands == 1 ? 0 : 2]};
    const std::uint64_t rays =
        add_true_view(*truth.surfaces, {exit.origin, exit.direction}, share, key, number, seen);
    for (std::size_t l = 0; l < sum.size(); ++l) {
        sum[l] += weight * seen[l];
    }
    return rays;
}

// Luminance toward `toward`, unit, inside (0: the receiver's normal), less the factor F_t, of
// light that crosses the body straight, as the harmonics hold it: random views, that look at the
// lights themselves. No cube map, wavelets or spiral of the bake. Around exits the lights are
// spread over 5 degrees, because no view meets a sun's disc; so bakes do by more or less. `key`:
// of the random numbers.
TwoEstimates see_lights_through(const StraightBody& body, const StraightTruth& truth,
                                const BodyPoint& point, glm::vec3 toward, std::uint64_t seed,
                                std::uint32_t key, std::uint64_t& traced) {
    const std::size_t lights = truth.lights.size();
    TwoEstimates estimates{Luminance(lights), Luminance(lights)};
    if (point.normal == glm::vec3(0)) return estimates;
    const ViewKernel kernel(point.normal, body.eta, truth.terms,
                            toward == glm::vec3(0) ? point.normal : toward);
    const double mean = 1 - fresnel_moments(body.eta).external;
    const StraightStart start = make_straight_start(body, point, traced);
    const Frame frame = make_frame(point.normal);
    std::vector<glm::vec3> seen;
    std::vector<double> weight;
    std::vector<std::array<float, 4>> random;
    std::vector<double> share;
    StraightLight found;
    std::uint32_t number = 0, looks = 0;
    for (Luminance* estimate : {&estimates.first, &estimates.second}) {
        seen.clear(), weight.clear(), random.clear(), share.clear();
        found = {};
        for (std::uint32_t i = 0; i < truth.views; ++i, ++number) {
            // Cosine-distributed, c^2 stratified.
            const auto u = random_uniform(seed, RandomStage::true_straight_views, key, number);
            const double c = std::sqrt(1 - (i + static_cast<double>(u[0])) / truth.views);
            const double passed = fresnel_transmittance(c, body.eta);
            if (!(passed > 0)) continue;
            const double inside = refracted_cosine(c, body.eta);
            const double sine = std::sqrt(1 - inside * inside);
            const double azimuth = 2 * std::numbers::pi * static_cast<double>(u[1]);
            seen.push_back(glm::normalize(frame.to_world(glm::vec3(
                glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), inside)))));
            share.push_back(passed / (mean * truth.views));
            weight.push_back(share.back() * kernel(seen.back()));
            random.push_back(u);
        }
        traced += follow_straight(body, start, seen, found);
        double left = 1;
        for (const std::uint32_t i : found.past) {
            left -= share[i];
        }
        if (!(left > 0)) continue;
        for (const StraightExit& exit : found.exits) {
            add_light(truth, exit.direction,
                      weight[exit.view] / left * luminance_of(exit, body.bands) *
                          let_through(truth.smooth.between, exit.origin, exit.direction),
                      random[exit.view], *estimate);
        }
        if (truth.surfaces) {
            for (const StraightExit& exit : found.blocked) {
                traced += add_surface(truth, exit, body.bands, weight[exit.view] / left,
                                      kOfViews | key, looks++, *estimate);
            }
        }
    }
    return estimates;
}

// A view through a body: its flights, and rays beyond its exits. A texel of one row and band, and
// half an exit's share of one.
constexpr CostBySize kStraightView{4.7e-6, 7.6e-6};
constexpr double kStraightCell = 4.7e-9;
// Exits of a view, each in sixteen parts.
constexpr double kPartsPerView = 32;

double cells(double texels, double views, double rows) {
    return rows * (texels + kPartsPerView * views);
}

// Work of rows with that many views of a receiver, and of truths with that many.
Work straight_rows_work(const SubjectCost& cost, double views) {
    const auto texels = static_cast<double>(formats::cubemap_texels(cost.input.knobs.cubemap_size));
    const double rows = straight_terms(cost.layout) * cost.layout.bands();
    // Where a medium is dense, one short flight is all of a view, and few receivers have exits.
    // Where it is clear, more views are followed after them.
    constexpr double kOneFlight = 0.2, kFiner = kFinerViews;
    const double crossing = thin_share(cost.medium(), cost.facts);
    const double view = kStraightView.at(cost.input.triangles);
    return {0,
            cost.receivers * (views * view * (kOneFlight + (1 + kFiner - kOneFlight) * crossing) +
                              crossing * cells(texels, kFiner * views, rows) * kStraightCell)};
}

Work straight_truth_work(const SubjectCost& cost, double views) {
    return {0, cost.receivers * views * kStraightView.at(cost.input.triangles)};
}

constexpr std::array<DecisionRule, 2> kRules{
    {{"transmission", has_medium, decide_transmission,
      [](const PlanEntry& entry, RowLayout& layout) {
          layout.constant = layout.constant || entry.on;
          layout.crosses = entry.on;
          layout.fills_crossed = !entry.on && entry.all_orders;
      },
      nullptr, formats::TermSet::unscattered},
     {"transmission.view", has_medium, decide_straight_views,
      [](const PlanEntry& entry, RowLayout& layout) {
          layout.straight_harmonics = entry.on ? entry.terms : 0;
      },
      warn_of_reach}}};
constexpr std::array<const KnobSpec*, 2> kKnobs{&kStraightViews, &kStraightTerms};

struct Body : Prepared {
    StraightBody body;
};

PreparedPtr prepare(const EffectInputs& inputs, std::uint64_t&) {
    auto prepared = std::make_unique<Body>();
    prepared->body = make_straight_body(inputs);
    return prepared;
}

std::uint64_t add(const EffectInputs& inputs, const GatherReceiver& receiver, const DenseRow& row) {
    const OtherLight* const light = light_of(inputs);
    const StraightBody& body = static_cast<const Body&>(*inputs.own.prepared).body;
    const std::uint32_t views = whole(inputs.knobs, kStraightViews);
    if (light != nullptr && light->lamps != nullptr) {
        return add_straight_lamps(body, receiver.inside, views, inputs.layout, row, *light->lamps);
    }
    return add_straight(body, receiver.inside, views, inputs.layout, row,
                        light != nullptr ? light->surfaces.get() : nullptr);
}

std::vector<CrossingViews> look_from_all(const EffectInputs& inputs,
                                         std::span<const BodyPoint> points, std::uint64_t& rays) {
    const StraightBody body = make_straight_body(inputs);
    const std::uint32_t views = whole(inputs.knobs, kStraightViews);
    std::vector<CrossingViews> seen(points.size());
    for_each_block_in_order(
        points.size(), 16, inputs.context,
        [&](Range range) {
            std::uint64_t traced = 0;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                seen[i] = look_through(body, points[i], views, traced);
            }
            return traced;
        },
        [&](Range, std::uint64_t traced) { rays += traced; });
    return seen;
}

struct Truth : Prepared {
    StraightBody body;
    StraightTruth truth;
};

// For each of two estimates.
std::uint32_t truth_views(TruthEffort effort) {
    return effort.target >= 0.03 ? 512 : 1024;
}

PreparedPtr make_truth(const EffectInputs& inputs, TruthEffort effort,
                       std::span<const TestLight> lights) {
    auto truth = std::make_unique<Truth>();
    truth->body = make_straight_body(inputs);
    truth->body.sky = &inputs.bake.rays;  // whatever the plan says of what stands before the light
    truth->truth = {lights, make_smooth_lights(lights, inputs.bake.between), truth_views(effort),
                    straight_terms(inputs.layout), true_light_of(inputs, lights)};
    return truth;
}

TwoEstimates eval(const EffectInputs& inputs, const Prepared& prepared,
                  const TruthReceiver& receiver, std::uint64_t& rays) {
    const auto& truth = static_cast<const Truth&>(prepared);
    return see_lights_through(truth.body, truth.truth, receiver.inside, receiver.seen,
                              inputs.knobs.seed, receiver.key, rays);
}

// What is behind a clear body is not seen sharply.
void warn_of_model(const EffectInputs& inputs, std::vector<formats::Diagnostic>& warnings) {
    constexpr double kWorthSaying = 0.1;
    const MaterialFacts& facts = inputs.bake.facts.material[inputs.material];
    const double share = typical_share(inputs.medium(), facts);
    if (share < kWorthSaying) return;
    const std::uint32_t terms = straight_terms(inputs.layout);
    warnings.push_back(formats::make_warning(
        "", "material '" + inputs.bake.scene.materials[inputs.material].name + "'",
        std::string(facts.has_thickness() ? "some " : "up to ") +
            std::to_string(static_cast<int>(std::lround(100 * share))) +
            " % of even light crosses the body unscattered, and " +
            (terms == 1 ? "one row shows its mean over all views"
                        : std::to_string(terms) + " rows blur it over tens of degrees of view") +
            ": its energy is right, but what stands behind is not seen sharply, and suns shine "
            "through it evenly",
        "measure it with --check-model"));
}

}  // namespace

EffectDescriptor describe_transmission(Effect id) {
    return {.id = id,
            .name = "transmission",
            .help = "light that crosses media unscattered",
            .inside_media = true,
            .rules = kRules,
            .knobs = kKnobs,
            .prepare = {.run = prepare},
            .gather = {.add = add,
                       .work =
                           [](const SubjectCost& cost) {
                               return straight_rows_work(cost, cost.input.knobs[kStraightViews]);
                           }},
            .truth = {.reference = "random views through the body",
                      .is_expensive = true,
                      .make = make_truth,
                      .eval = eval,
                      .work =
                          [](const SubjectCost& cost, TruthEffort effort) {
                              return straight_truth_work(cost, 2.0 * truth_views(effort));
                          }},
            .look_through = look_from_all,
            .warn_of_model = warn_of_model};
}

}  // namespace opaline::bake
