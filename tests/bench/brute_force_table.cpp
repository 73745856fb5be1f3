// What the hierarchy and the coefficients left out cost at production quality: rows of some
// receivers as the bake makes them, against the sum over all its samples with all coefficients and
// sixteen bits. Single scattering is gathered by rays in both. Prints a row of RESULTS.md's table:
// opaline_bench brute-force-table SCENE MEDIA.json; minutes.
#include <array>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/check/pilot/pilot_rows.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "bake/scene/orient_bodies.h"
#include "formats/gltf/import_gltf.h"
#include "formats/media/apply_media.h"
#include "formats/media/read_media.h"
#include "tests/bench/bench.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kReceivers = 400;

// Luminance of the receivers under each light, and the seconds that their rows took.
struct Rows {
    std::vector<CheckedPair> pairs;
    double seconds = 0;
};

Rows make_rows(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
               const Knobs& knobs, const Encoding& encoding) {
    Knobs setting = knobs;
    setting.exact_rays = true;
    const PilotRows rows(pilot, receivers, setting);
    const Clock::time_point start = Clock::now();
    auto pairs = rows.measure(std::array{encoding});
    return {std::move(pairs.front()), seconds_since(start)};
}

int compare(const std::string& file, const std::string& media_file) {
    auto imported = formats::import_gltf(file);
    const auto media = formats::read_media(media_file);
    if (!imported || !media || !formats::apply_media(*media, imported->scene)) {
        std::fprintf(stderr, "cannot read %s or %s\n", file.c_str(), media_file.c_str());
        return 1;
    }
    const OrientedBodies bodies = orient_bodies(imported->scene);
    const formats::Scene& scene = bodies.scene ? *bodies.scene : imported->scene;
    BakeOptions options;
    options.quality = Quality::production;
    options.set(kMultipleModel, static_cast<double>(MultipleModel::dipole));  // the gather's error
    Knobs knobs = *resolve_knobs(options);
    Context context;
    context.threads = thread_count(context);
    const SceneFacts facts = inspect_scene(scene);
    const std::vector<PlanEntry> plan = plan_bake(scene, facts, knobs);
    const auto rays = RayScene::build(scene, context.threads);
    const auto sky = RayScene::build({}, context.threads);
    const std::vector<Receiver> vertices = make_vertex_receivers(scene);
    const std::vector<ReceiverSet> sets =
        make_vertex_sets(scene, vertices, make_body_points(scene, vertices));
    const BakeInputs bake{all_effects(), scene, facts, *rays, *sky, sets};
    const auto lights = make_test_lights(knobs.cubemap_size, context.threads);
    std::vector<SubjectState> subjects = begin_subjects(bake, plan, knobs);
    StageLog log;
    run_step(Step::study, bake, knobs, context, subjects, log);
    run_step(Step::samples, bake, knobs, context, subjects, log);
    const PilotScene pilot{bake, subjects, *lights, context};

    std::vector<PilotReceiver> receivers;
    for (std::uint32_t v = 0; v < vertices.size();
         v += static_cast<std::uint32_t>(1 + vertices.size() / kReceivers)) {
        const std::uint32_t material = set_of(sets, v).material;
        if (state_of(subjects, material).layout.translucent) {
            const Luminance none(lights->size());
            receivers.push_back({v, material, {none, none}});
        }
    }
    Knobs all = knobs;
    all.coefficients = kAllCoefficients;
    all.set(kEpsilon, 0);
    const Rows brute = make_rows(pilot, receivers, all, kUnencoded);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        for (std::size_t l = 0; l < lights->size(); ++l) {
            const double luminance = brute.pairs[i * lights->size() + l].error[0];
            receivers[i].truth.first[l] = receivers[i].truth.second[l] = luminance;
        }
    }
    const Rows own = make_rows(pilot, receivers, knobs, {knobs.coefficients, knobs.code_bits});

    std::printf("| %s | %zu | %.0f |", file.c_str(), receivers.size(), brute.seconds / own.seconds);
    for (std::size_t l = 0; l < lights->size(); ++l) {
        std::vector<CheckedPair> one;
        for (std::size_t i = l; i < own.pairs.size(); i += lights->size()) {
            one.push_back(own.pairs[i]);
        }
        std::printf(" %s %.2f %% |", (*lights)[l].name.c_str(), 100 * relative_rms(one));
    }
    std::printf(" all %.2f %% |\n", 100 * relative_rms(own.pairs));
    return 0;
}

}  // namespace
}  // namespace opaline::bake

int opaline::tests::brute_force_table(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: opaline_bench brute-force-table SCENE MEDIA.json\n");
        return 2;
    }
    return opaline::bake::compare(argv[1], argv[2]);
}
