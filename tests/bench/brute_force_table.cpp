// What the hierarchy and the coefficients left out cost at production quality: rows of some
// receivers as the bake makes them, against the sum over all its samples with all coefficients and
// sixteen bits. Single scattering is gathered by rays in both. Prints a row of RESULTS.md's table:
// opaline_brute_force SCENE MEDIA.json; minutes.
#include <array>
#include <chrono>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/accuracy/measure_error.h"
#include "bake/accuracy/pilot/pilot_rows.h"
#include "bake/scene/inspect_scene.h"
#include "bake/plan/plan_rules.h"
#include "bake/pipeline/prepare_media.h"
#include "bake/scene/orient_bodies.h"
#include "bake/receivers/vertex_receivers.h"
#include "formats/gltf/import_gltf.h"
#include "formats/media/apply_media.h"
#include "formats/media/read_media.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kReceivers = 400;

using Clock = std::chrono::steady_clock;

// Luminance of the receivers under each light, and the seconds that their rows took.
struct Rows {
    std::vector<CheckedPair> pairs;
    double seconds = 0;
};

Rows make_rows(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
               const Knobs& knobs, const Encoding& encoding, std::span<const TestLight> lights,
               const Context& context) {
    BakeResult unused;
    const MediaStages media = prepare_media(pilot, knobs, context, unused);
    const RowSetting setting{knobs.tolerance, knobs[kDepthSamples], knobs[kSingleCubemap]};
    const PilotSingles single = gather_pilot_single(pilot, receivers, setting, context);
    const Clock::time_point start = Clock::now();
    auto pairs = measure_rows(pilot, receivers, media, single, setting, knobs.cubemap_size,
                              std::array{encoding}, lights, context);
    return {std::move(pairs.front()), std::chrono::duration<double>(Clock::now() - start).count()};
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
    Knobs knobs = *resolve_knobs(options);
    Context context;
    context.threads = thread_count(context);
    const std::vector<PlanEntry> plan = plan_bake(scene, inspect_scene(scene), knobs);
    const std::vector<RowLayout> layouts = layout_rows(scene, plan, knobs);
    const auto rays = RayScene::build(scene, context.threads);
    const auto sky = RayScene::build({}, context.threads);
    const std::vector<Receiver> vertices = make_vertex_receivers(scene);
    const std::vector<BodyPoint> points = make_body_points(scene, vertices);
    const MediaProfiles profiles = make_profiles(scene, layouts, knobs.seed, context);
    const auto lights = make_test_lights(knobs.cubemap_size, context.threads);
    const PilotScene pilot{scene, *rays, *sky, vertices, vertices, points, layouts, profiles};

    std::vector<PilotReceiver> receivers;
    for (std::size_t v = 0; v < points.size(); v += 1 + points.size() / kReceivers) {
        if (layouts[points[v].material].translucent) {
            const Luminance none(lights->size());
            receivers.push_back({static_cast<std::uint32_t>(v), points[v].material, {none, none}});
        }
    }
    Knobs all = knobs;
    all.coefficients = kAllCoefficients;
    all.tolerance = 0;
    const Rows brute = make_rows(pilot, receivers, all, kUnencoded, *lights, context);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        for (std::size_t l = 0; l < lights->size(); ++l) {
            const double luminance = brute.pairs[i * lights->size() + l].error[0];
            receivers[i].truth.first[l] = receivers[i].truth.second[l] = luminance;
        }
    }
    const Rows own =
        make_rows(pilot, receivers, knobs, {knobs.coefficients, knobs.code_bits}, *lights, context);

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

int main(int argc, char** argv) {
    if (argc != 3) {
        std::fprintf(stderr, "usage: opaline_brute_force SCENE MEDIA.json\n");
        return 2;
    }
    return opaline::bake::compare(argv[1], argv[2]);
}
