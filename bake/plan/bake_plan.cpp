#include "bake/plan/bake_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bake/scattering/dipole.h"
#include "formats/media/mean_cosine.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::make_error;

struct Preset {
    std::uint32_t cubemap_size, coefficients, code_bits, samples;
    double tolerance;
};

Preset preset(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return {16, 64, 8, 20000, 3e-3};
        case Quality::preview:
            return {32, 128, 8, 60000, 1e-3};
        case Quality::production:
            return {64, 256, 8, 150000, 3e-4};
        default:
            return {64, kAllCoefficients, 16, 300000, 1e-5};
    }
}

// Occlusion rays per second and thread on a mesh of one triangle, and how it falls as the hierarchy
// grows a level: a fit to the visibility benchmark, good to a factor of two on another machine.
constexpr double kRaysPerSecond = 36e6;
constexpr double kSlowdownPerLevel = 0.11;

double predict_trace_seconds(double receivers, double triangles, const Knobs& knobs,
                             unsigned threads) {
    // Half of the 2N x 2N x 6 subtexels lie above a receiver's horizon.
    const double rays = receivers * 12.0 * knobs.cubemap_size * knobs.cubemap_size;
    const double level = std::log2(std::max(triangles, 1.0));
    return rays * (1.0 + kSlowdownPerLevel * level) / (kRaysPerSecond * threads);
}

std::uint64_t predict_row_bytes(const Knobs& knobs, std::uint64_t bands) {
    const std::uint64_t all = formats::cubemap_texels(knobs.cubemap_size);
    // Of a surface in the open half of all coefficients vanish, below the horizon.
    const std::uint64_t details = knobs.coefficients == kAllCoefficients
                                      ? (bands == 1 ? all / 2 : all)
                                      : std::min<std::uint64_t>(knobs.coefficients, all) - 6;
    const std::uint64_t index_bytes = all <= 65536 ? 2 : 4;
    return details * (index_bytes + bands * knobs.code_bits / 8) + bands * (6 * 2 + 8) + 4;
}

// What the rules ask of one material.
struct Subject {
    double receivers = 0, area = 0;  // area [m^2]
    float brightest_vertex = 0;
};

bool is_wanted(const Knobs& knobs, const char* effect) {
    return knobs.effects.empty() ||
           std::find(knobs.effects.begin(), knobs.effects.end(), effect) != knobs.effects.end();
}

PlanEntry plan_direct(const formats::Material& material, const Subject& subject,
                      double all_triangles, const Knobs& knobs, unsigned threads) {
    PlanEntry entry;
    entry.effect = "direct";
    entry.subject = material_subject(material);
    // Under `white` a diffuse surface sends back at most its albedo.
    const formats::Rgb c = material.base_color;
    entry.bound = static_cast<double>(std::max({c.r, c.g, c.b}) * subject.brightest_vertex);
    if (material.medium) {
        entry.bound = 0;
        entry.reason = "light enters the medium instead of being reflected diffusely";
    } else if (!is_wanted(knobs, "direct")) {
        entry.reason = "left out by --effects";
    } else if (entry.bound > 0) {
        entry.on = true;
        entry.reason = "the surface reflects diffusely";
        entry.predicted_seconds =
            predict_trace_seconds(subject.receivers, all_triangles, knobs, threads);
        entry.predicted_bytes =
            static_cast<std::uint64_t>(subject.receivers) * predict_row_bytes(knobs, 1);
    } else {
        entry.reason = "the base colour is black: nothing is reflected";
    }
    return entry;
}

PlanEntry plan_multiple(const formats::Material& material, const Subject& subject,
                        double all_triangles, const Knobs& knobs, unsigned threads) {
    constexpr double kLeastBound = 1.0 / 512;  // translucency.md 9
    const formats::Medium& medium = *material.medium;
    PlanEntry entry;
    entry.effect = "multiple";
    entry.subject = material_subject(material);
    const double g = formats::mean_cosine(medium.phase);
    double densest = 0;
    for (const auto& [sigma_s, sigma_a] : {std::pair{medium.sigma_s.r, medium.sigma_a.r},
                                           {medium.sigma_s.g, medium.sigma_a.g},
                                           {medium.sigma_s.b, medium.sigma_a.b}}) {
        const double reduced = (1 - g) * static_cast<double>(sigma_s);
        const auto absorbed = static_cast<double>(sigma_a);
        // Through a thin body light can come from both sides.
        entry.bound = std::max(entry.bound,
                               2 * dipole_total(make_dipole(DipoleKind::classic, reduced, absorbed,
                                                            static_cast<double>(medium.eta))));
        densest = std::max(densest, reduced + absorbed);
    }
    if (!is_wanted(knobs, "multiple")) {
        entry.reason = "left out by --effects";
        return entry;
    }
    if (entry.bound < kLeastBound) {
        entry.reason = "the medium absorbs nearly all that it scatters";
        return entry;
    }
    entry.on = true;
    const double samples = std::min(static_cast<double>(knobs.samples),
                                    std::max(2000.0, subject.area * densest * densest));
    entry.reason = "light scatters many times inside; " +
                   std::to_string(static_cast<std::uint64_t>(samples)) + " surface samples";
    // One ray a texel, a quarter of what a receiver on the surface traces; then a gather of some
    // hundreds of nodes for each receiver.
    constexpr double kGatherPerSecond = 4e8;  // coefficients, on one thread
    const double kept = knobs.coefficients == kAllCoefficients
                            ? static_cast<double>(formats::cubemap_texels(knobs.cubemap_size))
                            : static_cast<double>(knobs.coefficients);
    constexpr double kNodes = 800;
    entry.predicted_seconds = 0.25 * predict_trace_seconds(samples, all_triangles, knobs, threads) +
                              subject.receivers * kNodes * kept / (kGatherPerSecond * threads);
    entry.predicted_bytes =
        static_cast<std::uint64_t>(subject.receivers) * predict_row_bytes(knobs, 3);
    return entry;
}

}  // namespace

std::string_view quality_name(Quality quality) {
    constexpr std::array<std::string_view, 4> names{"draft", "preview", "production", "reference"};
    return names[static_cast<std::size_t>(quality)];
}

std::string material_subject(const formats::Material& material) {
    return "material '" + material.name + "'";
}

formats::Result<Knobs> resolve_knobs(const BakeOptions& options) {
    const Preset base = preset(options.quality);
    Knobs knobs{base.cubemap_size, base.coefficients, base.code_bits, base.samples,
                base.tolerance,    options.effects,   options.seed};
    if (options.samples != 0) {
        knobs.samples = options.samples;
    }
    if (options.tolerance >= 0) {
        knobs.tolerance = options.tolerance;
    }
    if (options.cubemap_size != 0) {
        if (!formats::is_valid_cubemap_size(options.cubemap_size)) {
            return make_error(ErrorKind::usage, "", "--cubemap",
                              std::to_string(options.cubemap_size) + " is not a cube map size",
                              "give 8, 16, 32, 64 or 128");
        }
        knobs.cubemap_size = options.cubemap_size;
    }
    if (options.coefficients != 0) {
        if (options.coefficients < 7) {
            return make_error(ErrorKind::usage, "", "--coefficients",
                              "the six face averages and one detail are the least",
                              "give 7 or more, or `all`");
        }
        knobs.coefficients = options.coefficients;
    }
    if (knobs.coefficients >= formats::cubemap_texels(knobs.cubemap_size)) {
        knobs.coefficients = kAllCoefficients;
    }
    return knobs;
}

std::vector<PlanEntry> plan_bake(const formats::Scene& scene, const Knobs& knobs,
                                 unsigned threads) {
    double triangles = 0;
    std::vector<Subject> subjects(scene.materials.size());
    for (const formats::Primitive& primitive : scene.primitives) {
        Subject& subject = subjects[primitive.material];
        triangles += static_cast<double>(primitive.index.size() / 3);
        subject.receivers += static_cast<double>(primitive.position.size());
        if (primitive.color.empty()) {
            subject.brightest_vertex = 1.0f;
        }
        for (const formats::Rgb c : primitive.color) {
            subject.brightest_vertex = std::max({subject.brightest_vertex, c.r, c.g, c.b});
        }
        if (scene.materials[primitive.material].medium) {
            subject.area += formats::surface_area(primitive);
        }
    }
    std::vector<PlanEntry> plan;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (subjects[i].receivers == 0) {
            continue;
        }
        const formats::Material& material = scene.materials[i];
        plan.push_back(plan_direct(material, subjects[i], triangles, knobs, threads));
        if (material.medium) {
            plan.push_back(plan_multiple(material, subjects[i], triangles, knobs, threads));
        }
    }
    return plan;
}

bool is_planned(const std::vector<PlanEntry>& plan, std::string_view effect,
                std::string_view subject) {
    return std::any_of(plan.begin(), plan.end(), [&](const PlanEntry& entry) {
        return entry.on && entry.effect == effect && entry.subject == subject;
    });
}

}  // namespace opaline::bake
