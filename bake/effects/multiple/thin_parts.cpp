#include "bake/effects/multiple/thin_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/lights/test_lights.h"
#include "bake/physics/fresnel.h"
#include "bake/plan/plan_input.h"
#include "bake/receivers/used_vertices.h"
#include "bake/trace/body.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

// Measured pairs of a mean chord in transport mean free paths and the error there.
struct Measured {
    double chord, error;
};
constexpr std::array<Measured, 6> kMeasured{
    {{3, 0.47}, {7, 0.24}, {15, 0.14}, {30, 0.10}, {70, 0.06}, {165, 0.04}}};
constexpr double kLargestError = 2;

double source_depth(double eta) {
    const double inside = fresnel_moments(eta).diffuse_internal();
    return 1 + 4.0 / 3 * (1 + inside) / (1 - inside);
}

}  // namespace

double boundary_reach(double eta) {
    return std::max(1.0, source_depth(eta) / source_depth(1.5));
}

std::array<double, 3> transport_lengths(const formats::Medium& medium,
                                        const MediumProfile& profile) {
    constexpr double kLeastShare = 0.1;
    const double g = formats::mean_cosine(medium.phase);
    const double most = std::max({profile.total(0), profile.total(1), profile.total(2)});
    const auto bands = bands_of(medium);
    std::array<double, 3> lengths{};
    for (std::size_t b = 0; b < 3; ++b) {
        const double extinction = (1 - g) * bands[b].sigma_s + bands[b].sigma_a;
        if (extinction > 0 && profile.total(b) > 0 && profile.total(b) >= kLeastShare * most) {
            lengths[b] = boundary_reach(static_cast<double>(medium.eta)) / extinction;
        }
    }
    return lengths;
}

double half_space_error(double chord) {
    if (!(chord > 0)) return kLargestError;
    // Straight lines in logarithms of both; the outermost two go on.
    std::size_t i = 0;
    while (i + 2 < kMeasured.size() && chord > kMeasured[i + 1].chord) {
        ++i;
    }
    const Measured& a = kMeasured[i];
    const Measured& b = kMeasured[i + 1];
    const double power = std::log(b.error / a.error) / std::log(b.chord / a.chord);
    return std::min(kLargestError, a.error * std::pow(chord / a.chord, power));
}

double closed_body_error(const std::array<double, 3>& lengths, double mean_chord) {
    const double longest = *std::max_element(lengths.begin(), lengths.end());
    return longest > 0 ? half_space_error(mean_chord / longest) : 0;
}

std::vector<BodyPoint> draw_body_points(const EffectInputs& inputs, std::size_t count) {
    std::vector<BodyPoint> all;
    for (const std::uint32_t r :
         find_used_vertices(inputs.bake.scene, inputs.bake.facts.slots.view())) {
        const ReceiverSet& set = set_of(inputs.bake.receivers, r);
        if (set.material == inputs.material && set.inside[r - set.first].normal != glm::vec3(0)) {
            all.push_back(set.inside[r - set.first]);
        }
    }
    std::vector<BodyPoint> drawn;
    for (const std::uint32_t v : draw_evenly(static_cast<std::uint32_t>(all.size()), count,
                                             RandomStage::pilot_receivers, inputs.knobs.seed)) {
        drawn.push_back(all[v]);
    }
    return drawn;
}

double open_body_error(const std::array<double, 3>& lengths, const RayScene& rays,
                       std::span<const BodyPoint> points) {
    constexpr float kNoLimit = 1e30f;  // beyond a hole nothing is near
    constexpr std::uint32_t kDirections = 4;
    double sum = 0;
    std::size_t ends = 0, count = 0;
    for (std::uint32_t p = 0; p < points.size(); ++p) {
        for (std::uint32_t d = 0; points[p].normal != glm::vec3(0) && d < kDirections; ++d) {
            const auto u = random_uniform(0, RandomStage::pilot_receivers, p, d);
            const float r = std::sqrt(u[0]), phi = 2 * std::numbers::pi_v<float> * u[1];
            BodyPoint point = points[p];
            point.normal =
                make_frame(point.normal)
                    .to_world({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u[0])});
            const InwardPath path = trace_inward_path(rays, point, kNoLimit);
            ++count;
            // Skip vertices whose normal points out of the body: the ray would not measure its
            // thickness.
            if (!path.open && path.length > 0) {
                sum += static_cast<double>(path.length);
                ++ends;
            }
        }
    }
    return ends == 0 ? 0
                     : closed_body_error(lengths, sum / static_cast<double>(ends)) *
                           static_cast<double>(ends) / static_cast<double>(count);
}

double body_error(const EffectInputs& inputs, const MediumProfile& profile) {
    constexpr std::size_t kMostDrawn = 256;
    const MaterialFacts& body = inputs.bake.facts.material[inputs.material];
    const auto lengths = transport_lengths(inputs.medium(), profile);
    return body.has_thickness()
               ? closed_body_error(lengths, 4 * std::abs(body.volume) / body.area)
               : open_body_error(lengths, inputs.bake.rays, draw_body_points(inputs, kMostDrawn));
}

void warn_of_thin_parts(const EffectInputs& inputs, const MediumProfile& profile,
                        std::vector<formats::Diagnostic>& warnings) {
    if (inputs.layout.at_entry) return;
    constexpr double kWorthSaying = 0.1;
    const double error = body_error(inputs, profile);
    if (error > kWorthSaying) {
        warnings.push_back(formats::make_warning(
            "", "material '" + inputs.bake.scene.materials[inputs.material].name + "'",
            "light crosses the body, but diffusion takes its surface for that of a half space: "
            "multiple scattering differs from the truth by about " +
                std::to_string(static_cast<int>(std::round(100 * error))) +
                " %, and by more where light comes from behind",
            "measure it with --check-model; denser media and thicker bodies err less"));
    }
}

}  // namespace opaline::bake
