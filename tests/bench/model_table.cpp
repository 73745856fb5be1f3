// How far the model is from the Monte Carlo reference, as the table of RESULTS.md states it: light
// that a file shows over light that there is, at one receiver. `opaline_model_table [ETA [K]]`
// prints it as markdown, of one index and with K rows by view where they are given; 9 minutes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/pipeline/pipeline.h"
#include "bake/reference/reference_image.h"
#include "bake/reference/reference_receivers.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"
#include "tests/support/sheets.h"

namespace opaline::bake {
namespace {

/// Radiance 1 from all sides, or from above alone.
formats::Environment make_light(bool above) {
    formats::Environment sky;
    sky.width = 2;
    sky.height = 4096;
    for (std::uint32_t row = 0; row < sky.height; ++row) {
        const float value = !above || row < sky.height / 2 ? 1.0f : 0.0f;
        sky.pixel.insert(sky.pixel.end(), 2, {value, value, value});
    }
    return sky;
}

struct Body {
    const char* name;
    std::vector<formats::Primitive> primitives;
    std::uint32_t vertex;  ///< receiver
    bool back_lit;         ///< from above alone, seen from below
};

constexpr std::uint32_t kCells = 8;

// `thickness` [m]; mean free paths are 1 cm.
Body make_sheet_body(const char* name, float thickness, bool back_lit) {
    const std::uint32_t middle = (kCells / 2) * (kCells + 2);
    const std::uint32_t face = (kCells + 1) * (kCells + 1);
    return {name, tests::make_sheet(thickness, kCells, 0.6f), middle + (back_lit ? face : 0),
            back_lit};
}

Body make_ball_body(const char* name, float radius, bool back_lit) {
    Body body{name, {tests::make_sphere(4, radius)}, 0, back_lit};
    const auto& normal = body.primitives[0].normal;
    const auto lowest =
        std::min_element(normal.begin(), normal.end(), [](auto a, auto b) { return a.y < b.y; });
    body.vertex = static_cast<std::uint32_t>(lowest - normal.begin());
    return body;
}

void print_ratio(const Body& body, const formats::Medium& medium, double views) {
    const formats::Scene scene = tests::make_translucent_scene(body.primitives, medium);
    const formats::Environment light = make_light(body.back_lit);
    BakeOptions options;
    options.effects = {"multiple", "single"};
    options.cubemap_size = 16;
    options.coefficients = kAllCoefficients;
    options.quality = Quality::production;
    if (views > 0) {
        options.set(kViewTerms, views);
    }
    const BakeResult baked = run_bake(scene, resolve_knobs(options).value(), {}).value();
    formats::Rgb radiance;
    runtime::shade_range(baked.asset.view(), runtime::project_environment(light, 16), body.vertex,
                         {&radiance, 1});

    const ReferenceScene walked = make_reference_scene(scene, 0).value();
    const LightSampler sampler = make_light_sampler(light, glm::mat3(1.0f));
    PathOptions paths;
    paths.terms = TermSet::single | TermSet::multiple;
    const auto receivers = choose_receivers(walked, 1u << 30, 0, std::nullopt);
    EstimateOptions wanted;
    wanted.samples = 20000;
    wanted.seconds = 10;
    const Estimate truth =
        estimate_receivers({walked, sampler, paths}, std::span(receivers).subspan(body.vertex, 1),
                           wanted, {})
            .value();
    const Moments& m = truth.pixel[0];
    const double ratio = static_cast<double>(radiance.g) / m.mean.y;
    std::printf(" %.2f ± %.2f |", ratio, ratio * std::sqrt(m.variance_of_mean().y) / m.mean.y);
    std::fflush(stdout);
}

void print_table(std::span<const float> indices, double views) {
    const std::vector<Body> bodies{make_sheet_body("slab of 40, white", 0.4f, false),
                                   make_ball_body("ball of 10, white", 0.05f, false),
                                   make_sheet_body("sheet of 1, white", 0.01f, false),
                                   make_sheet_body("sheet of 1, from behind", 0.01f, true),
                                   make_sheet_body("sheet of 5, from behind", 0.05f, true),
                                   make_ball_body("ball of 10, from behind", 0.05f, true)};
    std::printf("| index, albedo |");
    for (const Body& body : bodies) {
        std::printf(" %s |", body.name);
    }
    std::printf("\n|---|%s\n", "---:|---:|---:|---:|---:|---:|");
    for (const float eta : indices) {
        for (const float albedo : {0.5f, 0.9f, 0.99f}) {
            std::printf("| %g, %g |", static_cast<double>(eta), static_cast<double>(albedo));
            for (const Body& body : bodies) {
                print_ratio(body, tests::make_grey_medium(100 * albedo, 100 * (1 - albedo), eta),
                            views);
            }
            std::printf("\n");
        }
    }
}

}  // namespace
}  // namespace opaline::bake

int main(int count, char** argument) {
    constexpr std::array<float, 3> kIndices{1.0f, 1.3f, 1.5f};
    const float index = count > 1 ? std::strtof(argument[1], nullptr) : 0;
    const double views = count > 2 ? std::strtod(argument[2], nullptr) : 0;
    opaline::bake::print_table(index > 0 ? std::span(&index, 1) : std::span<const float>(kIndices),
                               views);
}
