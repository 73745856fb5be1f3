#include "bake/pipeline/refine_stage.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/check/error_warnings.h"
#include "bake/effects/emitters/plan_emitters.h"
#include "bake/exchange/lamps/lamps.h"
#include "bake/pipeline/predict_memory.h"
#include "bake/scene/copies.h"
#include "bake/scene/shared_rows.h"

namespace opaline::bake {
namespace {

// What a quality asks for. Between receivers a file then errs by about as much as at them.
struct Fineness {
    double error;  // RefineLimits::error
    double more;   // receivers that may be added, for each one given
    std::uint64_t least_more;
    double probes_per_receiver;
    std::uint32_t cubemap_size;
    std::size_t simplify_points;  // SimplifyLimits::points
};
constexpr std::array<Fineness, 4> kFineness{{{0.10, 1, 4000, 0.1, 8, 512},
                                             {0.045, 2, 20000, 0.25, 8, 768},
                                             {0.025, 4, 80000, 0.5, 16, 1024},
                                             {0.015, 8, 200000, 0.5, 16, 2048}}};

// Expected of the file (Knobs::error_target), of what interpolates between receivers.
double interpolation_budget(const Knobs& knobs) {
    return knobs.error_target > 0 ? 0.7 * knobs.error_target
                                  : kFineness[static_cast<std::size_t>(knobs.quality)].error;
}

std::vector<LampSources> wanted_lamps(const formats::Scene& scene, const Knobs& knobs) {
    std::vector<LampSources> lamps;
    if (!is_wanted(knobs, kEmitters)) return lamps;
    for (const Lamp& lamp : list_lamps(scene)) {
        lamps.push_back(make_lamp_sources(scene, lamp));
    }
    return lamps;
}

}  // namespace

RefineLimits refine_limits(const Knobs& knobs, std::uint64_t receivers) {
    const RefineChoice& choice = knobs.refine;
    const Fineness& fineness = kFineness[static_cast<std::size_t>(knobs.quality)];
    RefineLimits limits;
    limits.error = interpolation_budget(knobs);
    const auto more = static_cast<std::uint64_t>(fineness.more * static_cast<double>(receivers));
    limits.most_added = std::max(more, fineness.least_more);
    if (choice.max_receivers > 0) {
        limits.most_added = choice.max_receivers - std::min(choice.max_receivers, receivers);
    }
    limits.probes_per_receiver = fineness.probes_per_receiver;
    limits.cubemap_size = fineness.cubemap_size;
    limits.longest_edge = choice.mode == RefineChoice::Mode::edges ? choice.longest_edge : 0;
    limits.seed = knobs.seed;
    return limits;
}

Knobs fit_refinement(const EffectTable& effects, const formats::Scene& scene, Knobs knobs,
                     unsigned threads, std::uint64_t memory) {
    if (knobs.refine.mode == RefineChoice::Mode::off || scene.primitives.empty()) return knobs;
    const formats::Slots slots = knobs.simplify ? find_slots(scene) : formats::Slots{};
    const MemoryCounts counts = count_memory(effects, scene, slots.view(), knobs);
    const auto given = static_cast<double>(counts.scene.vertices);
    // Memory is linear in receivers and triangles.
    MemoryCounts twice = counts;
    twice.scene.vertices *= 2;
    twice.scene.indices *= 2;
    twice.opaque_rows *= 2;
    twice.translucent_rows *= 2;
    const double needed = predict_memory(effects, counts, knobs, threads).bytes();
    const double more = predict_memory(effects, twice, knobs, threads).bytes() - needed;
    const double left = std::max(0.0, static_cast<double>(memory) - needed);
    const auto receivers = static_cast<std::uint64_t>(given);
    const std::uint64_t wanted = receivers + refine_limits(knobs, receivers).most_added;
    if (more > 0 && left * given / more < static_cast<double>(wanted - receivers)) {
        knobs.refine.max_receivers = receivers + static_cast<std::uint64_t>(left * given / more);
    }
    return knobs;
}

formats::Result<ShareReport> share_copies_for_bake(const Knobs& knobs, const Context& context,
                                                   formats::Scene& scene) {
    const std::vector<CopiedMesh> copies = find_copied_meshes(scene);
    if (copies.empty()) return ShareReport{};
    if (!knobs.simplify) return ShareReport{copies.size(), 0, 0, copies};
    formats::Result<RayScene> rays = RayScene::build(scene, context.threads);
    if (!rays) return std::move(rays).error();
    return share_copies(*rays, {interpolation_budget(knobs) / 3, knobs.seed}, context, scene);
}

std::optional<formats::Diagnostic> describe_bound(const RefineReport& report) {
    // What errs by less passes unnoticed.
    constexpr double kNoticed = 0.1;
    if (!report.is_bounded() || (report.error_before > 0 && report.error_after < kNoticed)) {
        return std::nullopt;
    }
    const std::string left =
        report.error_before > 0
            ? "interpolation between them still errs by some " + error_percent(report.error_after)
            : "some edges are longer than --refine says";
    return formats::make_warning("", "refinement",
                                 "the limit of " + std::to_string(report.given + report.added) +
                                     " receivers is reached; " + left,
                                 "give a larger --max-receivers or a finer --quality, and a larger "
                                 "--memory-limit where memory is what ends it");
}

formats::Result<RefinedScene> refine_for_bake(const formats::Scene& scene, const Knobs& knobs,
                                              const Context& context, StageLog& log) {
    if (knobs.refine.mode == RefineChoice::Mode::off || scene.primitives.empty()) {
        return RefinedScene{};
    }
    std::uint64_t receivers = 0;
    for (const formats::Primitive& p : scene.primitives) {
        receivers += p.position.size();
    }
    formats::Result<RayScene> rays = RayScene::build(scene, context.threads);
    if (!rays) return std::move(rays).error();
    const std::vector<LampSources> lamps = wanted_lamps(scene, knobs);
    return run_stage(log, "refinement", [&](std::uint64_t& traced) {
        RefinedScene found =
            refine_scene(scene, *rays, lamps, refine_limits(knobs, receivers), context);
        traced += found.report.rays;
        return found;
    });
}

formats::Result<SimplifiedScene> simplify_for_bake(const formats::Scene& scene, const Knobs& knobs,
                                                   const Context& context, StageLog& log) {
    if (!knobs.simplify) return SimplifiedScene{};
    if (!has_dense_meshes(scene)) return SimplifiedScene{find_slots(scene), {}};
    formats::Result<RayScene> rays = RayScene::build(scene, context.threads);
    if (!rays) return std::move(rays).error();
    const Fineness& fineness = kFineness[static_cast<std::size_t>(knobs.quality)];
    SimplifyLimits limits;
    limits.error = interpolation_budget(knobs) / 3;
    // A pilot may choose finer cube maps.
    constexpr std::uint32_t kFinest = 32;
    const std::uint32_t cells =
        knobs.error_target > 0 ? std::max(kFinest, knobs.cubemap_size) : knobs.cubemap_size;
    limits.angle = std::numbers::pi / 2 / cells;
    limits.cubemap_size = fineness.cubemap_size;
    limits.points = fineness.simplify_points;
    limits.seed = knobs.seed;
    const std::vector<LampSources> lamps = wanted_lamps(scene, knobs);
    return run_stage(log, "simplification", [&](std::uint64_t& traced) {
        SimplifiedScene found = simplify_scene(scene, *rays, lamps, limits, context);
        traced += found.report.rays;
        return found;
    });
}

}  // namespace opaline::bake
