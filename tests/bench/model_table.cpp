// How far the model is from the Monte Carlo reference, as the table of RESULTS.md states it: light
// that files of two to six seeds show over light that there is, along the normals of some receivers
// side by side, with the standard error of both, as markdown; about 40 minutes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "bake/pipeline/pipeline.h"
#include "bake/reference/reference_receivers.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"
#include "tests/bench/bench.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"
#include "tests/support/sheets.h"

namespace opaline::bake {
namespace {

/// Radiance 1 from all sides, or from above alone.
formats::Environment make_model_light(bool above) {
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
    std::vector<std::uint32_t> vertices;  ///< receivers: their light is added up
    bool back_lit;                        ///< from above alone, seen from below
};

constexpr std::uint32_t kCells = 8;

// `thickness` [m]; mean free paths are 1 cm. The nine vertices in the middle of a face.
Body make_sheet_body(const char* name, float thickness, bool back_lit) {
    Body body{name, tests::make_sheet(thickness, kCells, 0.6f), {}, back_lit};
    const std::uint32_t row = kCells + 1, first = back_lit ? row * row : 0;
    for (std::uint32_t i = kCells / 2 - 1; i <= kCells / 2 + 1; ++i) {
        for (std::uint32_t j = kCells / 2 - 1; j <= kCells / 2 + 1; ++j) {
            body.vertices.push_back(first + i * row + j);
        }
    }
    return body;
}

// The vertices within 20 degrees of the lowest point.
Body make_ball_body(const char* name, float radius, bool back_lit) {
    constexpr float kCosine = -0.94f;
    Body body{name, {tests::make_sphere(4, radius)}, {}, back_lit};
    const auto& normal = body.primitives[0].normal;
    for (std::uint32_t v = 0; v < normal.size(); ++v) {
        if (normal[v].y < kCosine) {
            body.vertices.push_back(v);
        }
    }
    return body;
}

struct Mean {
    double value, error;  ///< mean and its standard error
};

// Light that a file shows along the normals, mean of the receivers; over seeds of the walks, until
// its standard error is 1 %.
Mean shown_light(const Body& body, const formats::Scene& scene, const formats::Environment& light) {
    constexpr int kFewest = 2, kMost = 6;
    Mean shown{0, HUGE_VAL};
    double sum = 0, squares = 0;
    for (int seed = 0; seed < kFewest || (seed < kMost && shown.error > 0.01 * shown.value);
         ++seed) {
        BakeOptions options;
        options.effects = {"multiple", "single"};
        options.cubemap_size = 16;
        options.coefficients = kAllCoefficients;
        options.quality = Quality::production;
        options.seed = static_cast<std::uint64_t>(seed);
        const BakeResult baked = run_bake(scene, resolve_knobs(options).value(), {}).value();
        const runtime::LightVector projected = runtime::project_environment(light, 16);
        double mean = 0;
        for (const std::uint32_t v : body.vertices) {
            formats::Rgb radiance;
            runtime::shade_range(baked.asset.view(), projected, v, {&radiance, 1});
            mean += static_cast<double>(radiance.g) / static_cast<double>(body.vertices.size());
        }
        sum += mean;
        squares += mean * mean;
        if (const double count = seed + 1; count > 1) {
            shown.value = sum / count;
            shown.error =
                std::sqrt(std::max(0.0, squares / count - shown.value * shown.value) / (count - 1));
        }
    }
    return shown;
}

// The light that there is: path tracing to a standard error of 0.7 %, for 12 s at most.
Mean true_light(const Body& body, const formats::Scene& scene, const formats::Environment& light) {
    const ReferenceScene walked = make_reference_scene(scene, 0).value();
    const LightSampler sampler = make_light_sampler(light, glm::mat3(1.0f));
    PathOptions paths;
    paths.terms = TermSet::single | TermSet::multiple;
    const auto all = choose_receivers(walked, 1u << 30, 0, std::nullopt);
    std::vector<ReferenceReceiver> receivers;
    for (const std::uint32_t v : body.vertices) {
        receivers.push_back(all[v]);
    }
    std::vector<Moments> moments(receivers.size());
    Mean mean{0, 1};
    EstimateOptions wanted;
    wanted.samples = 4096 / static_cast<std::uint32_t>(receivers.size());
    for (double seconds = 0; mean.error > 0.007 * mean.value && seconds < 12;) {
        const Estimate part =
            estimate_receivers({walked, sampler, paths}, receivers, wanted, {}).value();
        seconds += part.seconds;
        wanted.first += wanted.samples;
        const auto count = static_cast<double>(receivers.size());
        mean = {0, 0};
        for (std::size_t r = 0; r < receivers.size(); ++r) {
            moments[r].merge(part.pixel[r]);
            mean.value += moments[r].mean.y / count;
            mean.error += moments[r].variance_of_mean().y / (count * count);
        }
        mean.error = std::sqrt(mean.error);
    }
    return mean;
}

void print_ratio(const Body& body, const formats::Medium& medium) {
    const formats::Scene scene = tests::make_translucent_scene(body.primitives, medium);
    const formats::Environment light = make_model_light(body.back_lit);
    const Mean shown = shown_light(body, scene, light);
    const Mean truth = true_light(body, scene, light);
    const double ratio = shown.value / truth.value;
    std::printf(" %.3f ± %.3f |", ratio,
                ratio * std::hypot(shown.error / shown.value, truth.error / truth.value));
    std::fflush(stdout);
}

}  // namespace
}  // namespace opaline::bake

int opaline::tests::model_table(int, char**) {
    using namespace opaline::bake;
    const Body bodies[] = {make_sheet_body("slab of 40, white", 0.4f, false),
                           make_ball_body("ball of 10, white", 0.05f, false),
                           make_sheet_body("sheet of 1, white", 0.01f, false),
                           make_sheet_body("sheet of 1, from behind", 0.01f, true),
                           make_sheet_body("sheet of 5, from behind", 0.05f, true),
                           make_ball_body("ball of 10, from behind", 0.05f, true)};
    std::printf("| index, albedo |");
    for (const Body& body : bodies) {
        std::printf(" %s |", body.name);
    }
    std::printf("\n|---|---:|---:|---:|---:|---:|---:|\n");
    for (const float eta : {1.0f, 1.3f, 1.5f}) {
        for (const float albedo : {0.5f, 0.9f, 0.99f}) {
            std::printf("| %g, %g |", static_cast<double>(eta), static_cast<double>(albedo));
            for (const Body& body : bodies) {
                print_ratio(body, make_grey_medium(100 * albedo, 100 * (1 - albedo), eta));
            }
            std::printf("\n");
        }
    }
    return 0;
}
