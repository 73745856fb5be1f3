#include "bake/measure/model_warnings.h"

#include <cmath>
#include <string>

#include "bake/measure/measure_error.h"
#include "bake/measure/thin_parts.h"
#include "bake/plan/rules_single.h"
#include "bake/scattering/phase_series.h"

namespace opaline::bake {
namespace {

std::string whole_percent(double share) {
    return std::to_string(static_cast<int>(std::round(100 * share))) + " %";
}

}  // namespace

std::vector<formats::Diagnostic> describe_thin_bodies(const formats::Scene& scene,
                                                      const SceneFacts& facts, const RayScene& rays,
                                                      std::span<const BodyPoint> points,
                                                      const MediaStages& media,
                                                      std::uint64_t seed) {
    constexpr double kWorthSaying = 0.1;
    std::vector<formats::Diagnostic> warnings;
    constexpr std::size_t kMostDrawn = 256;
    const std::vector<std::uint32_t> drawn =
        draw_evenly(points.size(), kMostDrawn, RandomStage::held_back_receivers, seed);
    for (const auto& [m, stages] : media) {
        if (!stages.multiple) {
            continue;
        }
        const MaterialFacts& body = facts.material[m];
        const auto lengths = transport_lengths(*scene.materials[m].medium, stages.multiple->medium);
        const double error = body.is_closed() && body.area > 0
                                 ? closed_body_error(lengths, 4 * std::abs(body.volume) / body.area)
                                 : open_body_error(lengths, rays, m, points, drawn);
        if (error > kWorthSaying) {
            warnings.push_back(formats::make_warning(
                "", "material '" + scene.materials[m].name + "'",
                "light crosses the body, but diffusion takes its surface for that of a half space: "
                "multiple scattering differs from the truth by about " +
                    whole_percent(error) + ", and by more where light comes from behind",
                "measure it with --check-model; denser media and thicker bodies err less"));
        }
    }
    return warnings;
}

std::vector<formats::Diagnostic> describe_short_series(const formats::Scene& scene,
                                                       const std::vector<PlanEntry>& plan,
                                                       const Knobs& knobs) {
    constexpr std::uint32_t kMostTerms = 25, kDegrees = 5;
    std::vector<formats::Diagnostic> warnings;
    for (const PlanEntry& entry : plan) {
        if (entry.terms != kMostTerms) {
            continue;
        }
        const formats::Medium& medium = *scene.materials[entry.material].medium;
        const double error = phase_rms_relative(expand_phase(medium.phase, kDegrees), kMostTerms);
        if (error * single_share(medium) > knobs.phase_tolerance) {
            warnings.push_back(formats::make_warning(
                "", entry.subject,
                "the phase function is too narrow for " + std::to_string(kMostTerms) +
                    " terms, the most there are: they err by " + whole_percent(error) +
                    " of its RMS, and single scattering is wrong, in some views negative and "
                    "shown as black",
                "leave it out with --effects multiple, or lower the mean cosine g and keep "
                "(1 - g) sigma_s"));
        }
    }
    return warnings;
}

}  // namespace opaline::bake
