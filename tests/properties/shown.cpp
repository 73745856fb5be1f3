#include "tests/properties/shown.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "bake/base/context.h"
#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/interreflection/interreflection.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "formats/opal/cubemap.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"
#include "runtime/volumes/volume_march.h"
#include "tests/support/effects.h"

namespace opaline::tests {
namespace {

using formats::Rgb;
using formats::Vec3;

constexpr std::uint32_t kSide = formats::kMinCubemapSize;  // texels along an edge of a face

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

std::vector<float> same_everywhere(float radiance) {
    return std::vector<float>(formats::cubemap_texels(kSide), radiance);
}

Vec3 direction_of_texel(std::size_t i) {
    const auto n = static_cast<std::uint32_t>(i);
    return formats::texel_direction(kSide, n / (kSide * kSide), n / kSide % kSide, n % kSide);
}

runtime::LightVector project(const std::vector<float>& radiance) {
    std::vector<Rgb> texels;
    for (const float value : radiance) {
        texels.push_back({value, value, value});
    }
    return runtime::project_cubemap(texels, kSide);
}

constexpr double kAllBands = 3;
double mean(const Rgb& c) {
    return (double{c.r} + double{c.g} + double{c.b}) / kAllBands;
}

Vec3 to_floats(glm::dvec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

}  // namespace

formats::Result<bake::BakeResult> bake_coarsely(const formats::Scene& scene, unsigned threads,
                                                bool check_model) {
    bake::Context context;
    context.threads = threads;
    context.cache = std::filesystem::read_symlink("/proc/self/exe") += ".cache";
    bake::BakeOptions options = coarse_options(threads);
    options.check_model = check_model;
    const auto knobs = bake::resolve_knobs(options);
    if (!knobs) throw std::logic_error(knobs.error().diagnostics.front().fault);
    return bake::run_bake(scene, *knobs, context);
}

LightOfAll even_light(bool lamps) {
    return {"even", same_everywhere(1), lamps, 1};
}

LightOfAll half_sky(bool lamps) {
    LightOfAll light{"half the sky's", same_everywhere(1), lamps, 1};
    std::fill(light.texels.begin() + light.texels.size() / 2, light.texels.end(), 0.0f);
    return light;
}

LightOfAll sun_of(float radiance) {
    constexpr std::size_t kTexel = 75;
    LightOfAll light{"a sun's", same_everywhere(0), false, 0};
    light.texels[kTexel] = radiance;
    return light;
}

LightOfAll no_sky(bool lamps) {
    return {lamps ? "lamps'" : "no", same_everywhere(0), lamps, 0};
}

LightOfAll turned(const LightOfAll& light, const glm::dmat3& turn) {
    LightOfAll result = light;
    for (std::size_t i = 0; i < light.texels.size(); ++i) {
        const Vec3 d = direction_of_texel(i);
        result.texels[formats::texel_index(kSide, to_floats(turn * glm::dvec3(d.x, d.y, d.z)))] =
            light.texels[i];
    }
    return result;
}

LightOfAll scaled(float factor, LightOfAll light) {
    for (float& texel : light.texels) {
        texel *= factor;
    }
    light.background *= double{factor};
    return light;
}

LightOfAll sum(const LightOfAll& a, const LightOfAll& b) {
    LightOfAll result = a;
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        result.texels[i] += b.texels[i];
    }
    result.background += b.background;
    return result;
}

std::vector<LineOfSight> lines_through_volumes(const formats::Scene& scene) {
    constexpr int kLines = 8;
    std::vector<LineOfSight> lines;
    for (const formats::Volume& volume : scene.volumes) {
        const auto corners = volume.density.corners();
        const glm::dvec3 centre = 0.5 * (corners.front() + corners.back());
        const double reach = glm::length(corners.front() - centre);
        for (int i = 0; i < kLines; ++i) {
            const double angle = 0.8 * i;
            const glm::dvec3 along = glm::normalize(
                glm::dvec3(std::cos(angle), 0.7 * std::cos(3.0 * i), std::sin(angle)));
            lines.push_back(
                {centre - 2 * reach * along + 0.05 * i * reach * glm::dvec3(-along.z, 0, along.x),
                 along});
        }
    }
    return lines;
}

Shown show(const bake::BakeResult& baked, glm::dvec3 origin, const std::vector<LineOfSight>& lines,
           const LightOfAll& light) {
    const formats::AssetView asset = baked.asset.view();
    const runtime::LightVector sky = project(light.texels);
    std::vector<Rgb> radiance(asset.receivers());
    runtime::ShadeOptions options;
    options.threads = 1;
    if (!light.lamps) options.emitters = runtime::dark_emitters();
    runtime::shade(asset, sky, radiance, options);
    Shown shown;
    for (const formats::PrimitiveRecord& record : baked.asset.primitives) {
        auto& values = shown.vertices.emplace_back();
        for (std::uint32_t v = 0; v < record.vertex_count; ++v) {
            values.push_back(mean(radiance[record.first_vertex + v]));
        }
    }
    if (lines.empty()) return shown;
    runtime::RelightVolumesOptions relit{.threads = 1};
    relit.emitters = options.emitters;
    const runtime::VolumeLight in_volumes = runtime::relight_volumes(asset.volumes, sky, relit);
    const runtime::LitVolumes lit = runtime::light_volumes(asset.volumes, in_volumes);
    for (const LineOfSight& line : lines) {
        const runtime::MarchResult seen =
            runtime::march_volumes(lit, {to_floats(origin + line.from), to_floats(line.along)});
        shown.through_volumes.push_back(mean(seen.radiance) +
                                        light.background * mean(seen.transmittance));
    }
    return shown;
}

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

}  // namespace opaline::tests
