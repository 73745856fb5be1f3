// What the planner saves: ten scenes, each baked as planned and with everything forced on, one
// after the other in the same run, and beside the seconds that were predicted. The scenes are those
// of examples/matrix.sh, at draft quality.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "bake/example/example_scenes.h"
#include "bake/pipeline/cost_model.h"
#include "bake/pipeline/pipeline.h"
#include "bake/scene/inspect_scene.h"
#include "formats/gltf/import_gltf.h"
#include "formats/media/apply_media.h"
#include "formats/media/read_media.h"
#include "tests/support/effects.h"
#include "tests/support/scenes.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

// Radius 10 cm, in 20 k triangles.
formats::Scene ball() {
    return tests::make_scene({tests::make_sphere(5, 0.1f)});
}

// Two sides of a sheet, 10 cm wide, 0.3 mm thick, open at its rim.
formats::Scene leaf() {
    constexpr float kHalf = 1.5e-4f, kWidth = 0.1f;
    return tests::make_scene(
        {tests::make_quad({0, kHalf, 0}, {0, 0, kWidth}, {kWidth, 0, 0}, 48),
         tests::make_quad({0, -kHalf, 0}, {kWidth, 0, 0}, {0, 0, kWidth}, 48)});
}

formats::Scene example(const char* name) {
    const tests::TemporaryFolder folder;
    return formats::import_gltf(write_example(name, folder.path()).value().front()).value().scene;
}

formats::Scene knot() {
    return example("knot");
}

formats::Scene statue() {
    return example("statue");
}

// A closed body, 2 m long, with one material; without primitives where the assets are not there.
formats::Scene model() {
    const char* const given = std::getenv("OPALINE_ASSETS_DIR");
    const std::filesystem::path assets =
        given != nullptr ? given : OPALINE_SOURCE_DIR "/../shared/assets";
    auto imported = formats::import_gltf(assets / "gltf" / "spot-3k.glb");
    return imported ? std::move(imported).value().scene : formats::Scene{};
}

// As `opaline plan` states it before the first bake.
double predicted_seconds(const formats::Scene& scene, const Knobs& knobs) {
    const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
    const SceneFacts facts = inspect_scene(scene);
    auto plan = plan_bake(scene, facts, knobs);
    return predict_costs(scene, facts, knobs, {}, threads, plan).seconds;
}

void plan_against_everything(benchmark::State& state, formats::Scene (*make)(),
                             const char* medium) {
    formats::Scene scene = make();
    if (scene.primitives.empty()) {
        state.SkipWithError("no model; set OPALINE_ASSETS_DIR");
        return;
    }
    if (*medium != '\0') {
        const std::string text = std::string(R"({"materials": {)") + medium + "}}";
        const auto media = formats::parse_media(text, "", "");
        if (!media || !formats::apply_media(*media, scene)) {
            state.SkipWithError("the medium is not understood");
            return;
        }
    }
    BakeOptions options;
    options.quality = Quality::draft;
    const Knobs planned = *resolve_knobs(options);
    options.simulate_all = true;
    const Knobs forced = *resolve_knobs(options);
    double planned_seconds = 0, forced_seconds = 0;
    for (auto _ : state) {
        planned_seconds += run_bake(scene, planned, {}).value().seconds_total;
        forced_seconds += run_bake(scene, forced, {}).value().seconds_total;
    }
    const auto runs = static_cast<double>(state.iterations());
    state.counters["planned_s"] = planned_seconds / runs;
    state.counters["forced_s"] = forced_seconds / runs;
    state.counters["ratio"] = forced_seconds / planned_seconds;
    state.counters["predicted_over_measured"] =
        predicted_seconds(scene, planned) * runs / planned_seconds;
}

#define OPALINE_WAX \
    R"("sigma_s": [20, 18, 15], "sigma_a": [0.05, 0.1, 0.2], "unit": "1/m", "eta": 1.4)"
#define OPALINE_SCENE(name, make, medium)                          \
    BENCHMARK_CAPTURE(plan_against_everything, name, make, medium) \
        ->Unit(benchmark::kSecond)                                 \
        ->Iterations(1)                                            \
        ->UseRealTime()

OPALINE_SCENE(ball_opaque, ball, "");
OPALINE_SCENE(knot_opaque, knot, "");
OPALINE_SCENE(ball_clay, ball,
              R"("*": {"sigma_s": [200, 150, 100], "sigma_a": [40, 80, 150], "unit": "1/mm",
                       "eta": 1.3})");
OPALINE_SCENE(statue_marble, statue,
              R"("Statue": {"preset": "marble", "marble": {"scale": 0.04}})");
OPALINE_SCENE(leaf_open, leaf,
              R"("*": {"sigma_s": [2, 4, 1], "sigma_a": [2, 0.5, 4], "unit": "1/mm", "eta": 1.4})");
OPALINE_SCENE(model_wax, model, R"("*": {)" OPALINE_WAX "}");
OPALINE_SCENE(model_wax_forward, model,
              R"("*": {)" OPALINE_WAX R"(, "phase": {"type": "hg", "g": 0.5}})");
OPALINE_SCENE(model_ketchup, model, R"("*": {"preset": "ketchup"})");
OPALINE_SCENE(model_milk, model, R"("*": {"preset": "whole-milk"})");
OPALINE_SCENE(ball_ink, ball,
              R"("*": {"sigma_s": [0.001, 0.001, 0.001], "sigma_a": [1, 1, 1], "unit": "1/mm",
                       "eta": 1.33})");

}  // namespace
}  // namespace opaline::bake
