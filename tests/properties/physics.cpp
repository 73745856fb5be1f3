#include "tests/properties/physics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "bake/base/context.h"
#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/interreflection/interreflection_knobs.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "formats/opal/atomic_file.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/write_opal.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"
#include "runtime/volumes/volume_march.h"
#include "tests/properties/build_scene.h"
#include "tests/support/effects.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {
namespace {

using formats::Rgb;

constexpr std::uint32_t kSide = 8;  // texels along an edge of a face

bake::BakeOptions coarse_options(unsigned threads) {
    bake::BakeOptions options;
    options.quality = bake::Quality::draft;
    options.cubemap_size = kSide;
    options.coefficients = bake::kAllCoefficients;
    options.threads = threads;
    for (const auto& [knob, few] : {std::pair(&bake::kWalks, 20000),
                                    {&bake::kSites, 500},
                                    {&bake::kSamples, 500},
                                    {&bake::kBounceRays, 64},
                                    {&bake::kEmitterParticles, 5000},
                                    {&bake::kEmitterRays, 32},
                                    {&bake::kVolumeWalks, 16},
                                    {&bake::kVolumeSpacing, 2}}) {
        options.set(*knob, few);
    }
    return options;
}

formats::Result<bake::BakeResult> bake_coarsely(const formats::Scene& scene, unsigned threads) {
    bake::Context context;
    context.threads = threads;
    context.cache = std::filesystem::read_symlink("/proc/self/exe") += ".cache";
    const auto knobs = bake::resolve_knobs(coarse_options(threads));
    if (!knobs) throw std::logic_error(knobs.error().diagnostics.front().fault);
    return bake::run_bake(scene, *knobs, context);
}

std::string file_bytes(const formats::Asset& asset) {
    const TemporaryFolder folder;
    auto file = formats::AtomicFile::create(folder / "a.opal");
    if (!file || !formats::write_opal(asset.view(), std::move(*file))) return "";
    const auto bytes = formats::FileBytes::open(folder / "a.opal").value();
    return {reinterpret_cast<const char*>(bytes.bytes().data()), bytes.bytes().size()};
}

// Radiance over all texels from what is(texel) says.
template <class Radiance>
runtime::LightVector sky_of(Radiance&& radiance) {
    std::vector<Rgb> texels(formats::cubemap_texels(kSide));
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const float value = radiance(i);
        texels[i] = {value, value, value};
    }
    return runtime::project_cubemap(texels, kSide);
}

struct Shown {
    std::vector<std::vector<double>> vertices;  ///< of each primitive: radiance along its normal
    std::vector<double> through_volumes;  ///< along lines through the scene, of light behind 1
};

constexpr double kAllBands = 3;
double mean(const Rgb& c) {
    return (double{c.r} + double{c.g} + double{c.b}) / kAllBands;
}

Shown show(const bake::BakeResult& baked, const formats::Scene& scene,
           const runtime::LightVector& light, double background, bool lamps) {
    const formats::AssetView asset = baked.asset.view();
    std::vector<Rgb> radiance(asset.receivers());
    runtime::ShadeOptions options;
    options.threads = 1;
    if (!lamps) options.emitters = runtime::dark_emitters();
    runtime::shade(asset, light, radiance, options);
    Shown shown;
    for (const formats::PrimitiveRecord& record : baked.asset.primitives) {
        auto& values = shown.vertices.emplace_back();
        for (std::uint32_t v = 0; v < record.vertex_count; ++v) {
            values.push_back(mean(radiance[record.first_vertex + v]));
        }
    }
    if (scene.volumes.empty()) return shown;
    runtime::RelightVolumesOptions relit{.threads = 1};
    relit.emitters = options.emitters;
    const runtime::VolumeLight volume_light = runtime::relight_volumes(asset.volumes, light, relit);
    const runtime::LitVolumes lit = runtime::light_volumes(asset.volumes, volume_light);
    for (const formats::Volume& volume : scene.volumes) {
        const auto corners = volume.density.corners();
        const glm::dvec3 centre = 0.5 * (corners.front() + corners.back());
        const double reach = glm::length(corners.front() - centre);
        for (int i = 0; i < 8; ++i) {
            const double angle = 0.8 * i;
            const glm::dvec3 along = glm::normalize(
                glm::dvec3(std::cos(angle), 0.7 * std::cos(3.0 * i), std::sin(angle)));
            const glm::dvec3 from = scene.origin + centre - 2 * reach * along +
                                    0.05 * i * reach * glm::dvec3(-along.z, 0, along.x);
            const runtime::MarchResult seen = runtime::march_volumes(
                lit, {{static_cast<float>(from.x), static_cast<float>(from.y),
                       static_cast<float>(from.z)},
                      {static_cast<float>(along.x), static_cast<float>(along.y),
                       static_cast<float>(along.z)}});
            shown.through_volumes.push_back(mean(seen.radiance) +
                                            background * mean(seen.transmittance));
        }
    }
    return shown;
}

template <class Visit>
void for_each_value(const Shown& shown, Visit&& visit) {
    for (std::size_t p = 0; p < shown.vertices.size(); ++p) {
        for (std::size_t v = 0; v < shown.vertices[p].size(); ++v) {
            visit(shown.vertices[p][v], fmt::format("vertex {} of primitive {}", v, p));
        }
    }
    for (const double value : shown.through_volumes) {
        visit(value, std::string("a line through volumes"));
    }
}

std::optional<Fault> find_unsound(const Shown& shown, const char* light, bool is_dark) {
    std::optional<Fault> fault;
    for_each_value(shown, [&](double value, const std::string& where) {
        if (fault || (std::isfinite(value) && value >= 0 && (!is_dark || value == 0))) return;
        fault = {"finite", fmt::format("{} under {} light: {}", value, light, where)};
    });
    return fault;
}

// The error that the bake states of even light: how it blurs suns is no part of it.
double stated_of(const bake::BakeResult& baked) {
    double stated = 0;
    for (const auto& part : baked.error.by_light) {
        if (part.name == "white") stated = std::max(stated, part.rms_relative);
    }
    if (!baked.volume_error) return stated;
    for (const auto& part : baked.volume_error->by_light) {
        if (part.name == "even") stated = std::max(stated, part.rms_relative);
    }
    return stated;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) {
        sum += value;
    }
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

// What so few walks and rays are off by, of the mean of a primitive and of a vertex.
constexpr double kNoiseOfMean = 0.06, kNoise = 0.3;

std::optional<Fault> find_bright(const Shown& shown, const char* light, double stated) {
    for (std::size_t p = 0; p < shown.vertices.size(); ++p) {
        if (shown.vertices[p].empty()) continue;
        const double average = mean_of(shown.vertices[p]),
                     most = std::ranges::max(shown.vertices[p]);
        if (average > 1 + kNoiseOfMean + stated || most > 1 + kNoise + 3 * stated)
            return Fault{"bounds", fmt::format("{:.3f} in the mean, {:.3f} at most under {} light: "
                                               "primitive {} (stated error {:.3f})",
                                               average, most, light, p, stated)};
    }
    for (const double value : shown.through_volumes) {
        if (value > 1 + kNoise + 3 * stated)
            return Fault{"bounds", fmt::format("{:.3f} under {} light: a line through volumes",
                                               value, light)};
    }
    return std::nullopt;
}

std::optional<Fault> find_dark_or_bright(const BuiltScene& built, const Shown& shown,
                                         double stated) {
    double square = 0, count = 0;
    for (std::size_t p = 0; p < shown.vertices.size(); ++p) {
        if (built.shown[p] == 0) continue;
        std::vector<double> seen;
        for (std::size_t v = 0; v < shown.vertices[p].size(); ++v) {
            if (!built.exposed[p][v]) continue;
            seen.push_back(shown.vertices[p][v] / built.shown[p]);
            square += (seen.back() - 1) * (seen.back() - 1);
            count += 1;
        }
        const double average = mean_of(seen);
        if (!seen.empty() && std::abs(average - 1) > kNoiseOfMean + 1.5 * stated)
            return Fault{"furnace", fmt::format("primitive {} shows {:.3f} in the mean of {} "
                                                "vertices (stated error {:.3f})",
                                                p, average, seen.size(), stated)};
    }
    const double rms = std::sqrt(square / std::max(count, 1.0));
    if (rms > 1.5 * std::max(stated, kNoiseOfMean))
        return Fault{"stated error",
                     fmt::format("RMS {:.3f} in a furnace, {:.3f} stated", rms, stated)};
    for (const double value : shown.through_volumes) {
        if (std::abs(value - 1) > kNoise + stated)
            return Fault{"furnace", fmt::format("{:.3f} along a line through volumes", value)};
    }
    return std::nullopt;
}

bool has_lamps(const SceneWords& words) {
    return std::ranges::any_of(words.things, [](const Thing& t) {
        return t.kind == ThingKind::lamp || t.kind == ThingKind::glow || t.kind == ThingKind::bulb;
    });
}

}  // namespace

std::optional<Fault> find_fault(const SceneWords& words) {
    const BuiltScene built = build_scene(words);
    const auto baked = bake_coarsely(built.scene, 1);
    if (!baked) return Fault{"bakes", baked.error().diagnostics.front().fault};
    const auto see = [&](const runtime::LightVector& light, double background, bool lamps) {
        return show(*baked, built.scene, light, background, lamps);
    };
    const bool in_balance = built.in_balance;
    const double stated = stated_of(*baked);
    const auto white = sky_of([](std::size_t) { return 1.0f; });
    const auto black = sky_of([](std::size_t) { return 0.0f; });
    constexpr std::size_t kTexelOfSun = 75;
    const auto sun = sky_of([](std::size_t i) { return i == kTexelOfSun ? 1e30f : 0.0f; });
    const auto half = sky_of([](std::size_t i) { return i < kSide * kSide * 3 ? 1.0f : 0.0f; });
    if (auto fault = find_unsound(see(white, 1, true), "even", false)) return fault;
    if (auto fault = find_unsound(see(sun, 0, false), "a sun's", false)) return fault;
    if (auto fault = find_unsound(see(black, 0, false), "no", true)) return fault;
    const Shown in_furnace = see(white, 1, in_balance);
    if (built.is_furnace) {
        if (auto fault = find_dark_or_bright(built, in_furnace, stated)) return fault;
    }
    if (auto fault = find_bright(in_furnace, "even", stated)) return fault;
    if (auto fault = find_bright(see(half, 1, in_balance), "half the sky's", stated)) return fault;
    if (in_balance && has_lamps(words)) {
        if (auto fault = find_bright(see(black, 0, true), "lamps'", stated)) return fault;
    }
    return std::nullopt;
}

std::optional<Fault> find_fault_of_threads(const SceneWords& words) {
    const BuiltScene built = build_scene(words);
    const auto one = bake_coarsely(built.scene, 1), three = bake_coarsely(built.scene, 3);
    if (one && three && file_bytes(one->asset) == file_bytes(three->asset)) return std::nullopt;
    return Fault{"threads", "1 and 3 threads make different bytes"};
}

std::string inspect(const SceneWords& words) {
    const BuiltScene built = build_scene(words);
    const auto baked = bake_coarsely(built.scene, 1);
    if (!baked) return baked.error().diagnostics.front().fault;
    std::string text;
    for (const bake::StageReport& stage : baked->stages) {
        if (stage.seconds > 0.1) text += fmt::format("{}: {:.1f} s\n", stage.name, stage.seconds);
    }
    const Shown shown =
        show(*baked, built.scene, sky_of([](std::size_t) { return 1.0f; }), 1, true);
    for (std::size_t p = 0; p < shown.vertices.size(); ++p) {
        double least = 1e30, most = 0, sum = 0, count = 0;
        for (std::size_t v = 0; v < shown.vertices[p].size(); ++v) {
            if (!built.exposed[p][v]) continue;
            least = std::min(least, shown.vertices[p][v]);
            most = std::max(most, shown.vertices[p][v]);
            sum += shown.vertices[p][v];
            count += 1;
        }
        text += fmt::format(
            "{}: {} of {} vertices seen, {:.3f} to {:.3f}, mean {:.3f} of {:.3f}; all {:.3f}\n",
            built.scene.primitives[p].name, count, shown.vertices[p].size(), least, most,
            sum / count, built.shown[p], mean_of(shown.vertices[p]));
    }
    for (const double value : shown.through_volumes) {
        text += fmt::format("{:.3f} ", value);
    }
    text += fmt::format("stated {:.3f}, of even light {:.3f}\n", baked->error.rms_relative,
                        stated_of(*baked));
    for (const formats::Diagnostic& warning : baked->warnings) {
        text += warning.where + ": " + warning.fault + "\n";
    }
    return text;
}

}  // namespace opaline::tests
