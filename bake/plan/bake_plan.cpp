#include "bake/plan/bake_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::make_error;

struct Preset {
    std::uint32_t cubemap_size, coefficients, code_bits;
};

Preset preset(Quality quality) {
    switch (quality) {
        case Quality::draft:
            return {16, 64, 8};
        case Quality::preview:
            return {32, 128, 8};
        case Quality::production:
            return {64, 256, 8};
        default:
            return {64, kAllCoefficients, 16};
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

std::uint64_t predict_row_bytes(const Knobs& knobs) {
    const std::uint64_t all = formats::cubemap_texels(knobs.cubemap_size);
    // Half of all coefficients vanish below the horizon.
    const std::uint64_t details = knobs.coefficients == kAllCoefficients
                                      ? all / 2
                                      : std::min<std::uint64_t>(knobs.coefficients, all) - 6;
    const std::uint64_t index_bytes = all <= 65536 ? 2 : 4;
    return details * (index_bytes + knobs.code_bits / 8) + 6 * 2 + 12;
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
    Knobs knobs{base.cubemap_size, base.coefficients, base.code_bits, options.seed};
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
    std::vector<double> receivers(scene.materials.size(), 0.0);
    std::vector<float> brightest_vertex(scene.materials.size(), 0.0f);
    for (const formats::Primitive& primitive : scene.primitives) {
        triangles += static_cast<double>(primitive.index.size() / 3);
        receivers[primitive.material] += static_cast<double>(primitive.position.size());
        float& brightest = brightest_vertex[primitive.material];
        if (primitive.color.empty()) {
            brightest = 1.0f;
        }
        for (const formats::Rgb c : primitive.color) {
            brightest = std::max({brightest, c.r, c.g, c.b});
        }
    }
    std::vector<PlanEntry> plan;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (receivers[i] == 0) {
            continue;
        }
        const formats::Material& material = scene.materials[i];
        const formats::Rgb c = material.base_color;
        PlanEntry entry;
        entry.effect = "direct";
        entry.subject = material_subject(material);
        // Under `white` a diffuse surface sends back at most its albedo.
        entry.bound = static_cast<double>(std::max({c.r, c.g, c.b}) * brightest_vertex[i]);
        entry.on = entry.bound > 0;
        if (entry.on) {
            entry.reason = "the surface reflects diffusely";
            entry.predicted_seconds =
                predict_trace_seconds(receivers[i], triangles, knobs, threads);
            entry.predicted_bytes =
                static_cast<std::uint64_t>(receivers[i]) * predict_row_bytes(knobs);
        } else {
            entry.reason = "the base colour is black: nothing is reflected";
        }
        plan.push_back(std::move(entry));
    }
    return plan;
}

}  // namespace opaline::bake
