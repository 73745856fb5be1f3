#include "bake/check/volumes/volume_error.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bake/check/model_pairs.h"
#include "bake/check/volumes/see_through.h"
#include "bake/check/volumes/volume_probes.h"
#include "runtime/light_vector.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"

namespace opaline::bake {
namespace {

// As measure_error.cpp has it: the chance of an unseen share is e^-2.
constexpr std::size_t kUnseen = 2;

double squared_error(const ModelPair& pair) {
    return pair.difference * pair.difference - pair.variance;
}

// `pairs`: place after place. The upper end allows for probes that err as the worst of these does.
std::array<double, 2> stated_interval(std::span<const ModelPair> pairs, std::size_t probes,
                                      std::uint64_t seed) {
    std::array<double, 2> ends = model_interval(pairs, probes, seed);
    std::size_t worst = 0;
    double most = -1;
    for (std::size_t p = 0; p < probes; ++p) {
        double sum = 0;
        for (std::size_t i = p; i < pairs.size(); i += probes) {
            sum += squared_error(pairs[i]);
        }
        if (sum > most) {
            most = sum;
            worst = p;
        }
    }
    std::vector<ModelPair> more;
    for (std::size_t first = 0; first < pairs.size(); first += probes) {
        const auto own = pairs.subspan(first, probes);
        more.insert(more.end(), own.begin(), own.end());
        more.insert(more.end(), kUnseen, own[worst]);
    }
    ends[1] = std::max(ends[1], model_interval(more, probes + kUnseen, seed)[1]);
    return ends;
}

// Pairs of each place, relative to the RMS of its truth: all places count alike.
std::vector<ModelPair> relative_pairs(std::span<const ModelPair> pairs, std::size_t probes) {
    std::vector<ModelPair> relative;
    for (std::size_t first = 0; first < pairs.size(); first += probes) {
        const auto own = pairs.subspan(first, probes);
        const double square = sum_up(own).truth / static_cast<double>(probes);
        const double scale = square > 0 ? 1 / std::sqrt(square) : 0;
        for (const ModelPair& pair : own) {
            relative.push_back(
                {scale * pair.difference, scale * pair.truth, scale * scale * pair.variance});
        }
    }
    return relative;
}

// A class of views without light has no error relative to its truth: the RMS of that is taken as a
// tenth of the one under even light where it is less. A white surface is as bright under both.
void raise_dark_places(std::vector<ModelPair>& pairs) {
    constexpr double kDark = 0.1;
    const std::size_t probes = pairs.size() / kLightPlaces;
    const auto square_of = [&](std::size_t place) {
        const auto own = std::span<const ModelPair>(pairs).subspan(place * probes, probes);
        return std::max(0.0, sum_up(own).truth) / static_cast<double>(probes);
    };
    const double least = kDark * kDark * square_of(static_cast<std::size_t>(LightPlace::around));
    for (std::size_t place = 0; place < kLightPlaces; ++place) {
        const double missing = least - square_of(place);
        for (std::size_t i = place * probes; missing > 0 && i < (place + 1) * probes; ++i) {
            pairs[i].truth = std::sqrt(pairs[i].truth * pairs[i].truth + missing);
        }
    }
}

// Of scattered light; place after place.
std::vector<ModelPair> make_pairs(std::span<const double> luminance, const VolumeTruth& truth) {
    std::vector<ModelPair> pairs;
    for (std::size_t i = 0; i < luminance.size(); ++i) {
        const double mean = truth.luminance[i].mean.x;
        pairs.push_back({luminance[i] - mean, mean, truth.luminance[i].variance_of_mean().x});
    }
    raise_dark_places(pairs);
    return pairs;
}

// The differences under even light, including light that passes through.
std::vector<ModelPair> with_passing(std::vector<ModelPair> pairs, std::span<const double> through,
                                    const VolumeTruth& truth) {
    const std::size_t first = static_cast<std::size_t>(LightPlace::around) * through.size();
    for (std::size_t p = 0; p < through.size(); ++p) {
        pairs[first + p].difference += through[p] - truth.through[p];
    }
    return pairs;
}

// Relative to the truth: difference and noise, in squares the means over places.
MeanSquares sum_up_places(std::span<const double> luminance, std::span<const double> through,
                          const VolumeTruth& truth) {
    const std::vector<ModelPair> pairs = with_passing(make_pairs(luminance, truth), through, truth);
    return sum_up(relative_pairs(pairs, pairs.size() / kLightPlaces));
}

// The same volumes among surfaces that neither reflect nor send out light.
formats::Scene with_black_surfaces(const formats::Scene& scene) {
    formats::Scene black = scene;
    formats::Material dark;
    dark.base_color = {0, 0, 0};
    dark.double_sided = true;
    std::ranges::fill(black.materials, dark);
    black.lights.clear();
    return black;
}

MeanSquares compare(std::span<const double> luminance, const VolumeTruth& truth) {
    std::vector<ModelPair> pairs;
    for (std::size_t i = 0; i < luminance.size(); ++i) {
        const double mean = truth.luminance[i].mean.x;
        pairs.push_back({luminance[i] - mean, mean, truth.luminance[i].variance_of_mean().x});
    }
    return sum_up(pairs);
}

formats::Vec3 to_vec3(glm::dvec3 v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

double luminance_along(const runtime::LitVolumes& lit, glm::dvec3 origin, const VolumeRay& ray) {
    const runtime::MarchResult seen = runtime::march_volumes(
        lit, {to_vec3(origin + glm::dvec3(ray.origin)), to_vec3(glm::dvec3(ray.direction)), 0,
              static_cast<double>(ray.end)});
    return static_cast<double>(formats::luminance(seen.radiance));
}

}  // namespace

VolumeErrorReport compare_volumes(std::span<const double> luminance,
                                  std::span<const double> through, const VolumeTruth& truth,
                                  std::uint64_t seed) {
    VolumeErrorReport report;
    const std::size_t probes = luminance.size() / kLightPlaces;
    if (probes == 0) return report;
    const std::vector<ModelPair> scattered = make_pairs(luminance, truth);
    const std::vector<ModelPair> pairs = with_passing(scattered, through, truth);
    for (std::size_t place = 0; place < kLightPlaces; ++place) {
        const auto own = std::span<const ModelPair>(pairs).subspan(place * probes, probes);
        const MeanSquares sum = sum_up(own);
        VolumeErrorReport::Part part{
            .name = std::string(kLightPlaceNames[place]),
            .rms_relative = sum.rms_relative(),
            .bias = sum.bias(),
            .noise = sum.noise(),
            .scattered_alone =
                sum_up(std::span<const ModelPair>(scattered).subspan(place * probes, probes))
                    .rms_relative()};
        std::ranges::copy(stated_interval(own, probes, seed), part.ci95);
        report.by_light.push_back(std::move(part));
    }
    const std::vector<ModelPair> relative = relative_pairs(pairs, probes);
    report.rms_relative = sum_up(relative).rms_relative();
    std::ranges::copy(stated_interval(relative, probes, seed), report.ci95);
    report.rays_checked = static_cast<std::uint32_t>(luminance.size());
    report.samples = std::uint64_t{truth.samples} * report.rays_checked;
    report.events = truth.events;
    report.reference =
        "path tracing; luminance that volumes scatter along rays through points drawn in "
        "proportion to extinction, under suns ahead of the eye, beside it and behind it, and "
        "under even light, there with what passes through";
    return report;
}

formats::Result<VolumeErrorReport> check_volumes(const formats::Scene& scene,
                                                 const formats::AssetView& asset,
                                                 const VolumeCheckOptions& options,
                                                 const Context& context) {
    const auto reference = make_reference_scene(scene, context.threads);
    if (!reference) return reference.error();
    const std::vector<VolumeProbe> probes =
        choose_volume_probes(*reference, options.probes, options.seed);
    if (probes.empty()) return VolumeErrorReport();
    const std::vector<double> luminance =
        march_probes(asset.volumes, asset.cubemap_size, scene.origin, probes, context.threads);
    const std::vector<double> through =
        see_through_file(asset.volumes, asset.cubemap_size, scene.origin, probes, context.threads);
    TermSet terms = TermSet::volume_single | TermSet::volume_multiple;
    if (options.sees_surfaces) {
        terms = terms | TermSet::interreflection;
    }
    const auto truth = trace_volume_truth(
        *reference, probes, options.seed, options.max_events,
        [&](const VolumeTruth& so_far) {
            const MeanSquares sum = sum_up_places(luminance, through, so_far);
            return sum.noise() <= std::max(options.noise, options.noise_share * sum.rms_relative());
        },
        context, terms);
    if (!truth) return truth.error();
    return compare_volumes(luminance, through, *truth, options.seed);
}

namespace {

// The light of some emitters of a file against all that a scene's lamps and volumes send out.
formats::Result<GlowErrorReport> check_emitted(const formats::Scene& shown,
                                               const formats::AssetView& asset,
                                               const runtime::EmitterLight& emitters,
                                               const VolumeCheckOptions& options,
                                               const Context& context) {
    const auto reference = make_reference_scene(shown, context.threads);
    if (!reference) return reference.error();
    GlowErrorReport report;
    const std::vector<VolumeProbe> probes =
        choose_volume_probes(*reference, options.probes, options.seed);
    if (probes.empty()) return report;
    const std::vector<double> luminance =
        march_glow(asset.volumes, shown.origin, probes, context.threads, emitters);
    const auto truth = trace_volume_truth(
        *reference, probes, options.seed, options.max_events,
        [&](const VolumeTruth& so_far) {
            const MeanSquares sum = compare(luminance, so_far);
            return sum.noise() <= std::max(options.noise, options.noise_share * sum.rms_relative());
        },
        context, TermSet::emitters);
    if (!truth) return truth.error();
    const MeanSquares sum = compare(luminance, *truth);
    report.rms_relative = sum.rms_relative();
    report.bias = sum.bias();
    report.noise = sum.noise();
    report.rays_checked = static_cast<std::uint32_t>(luminance.size());
    report.events = truth->events;
    return report;
}

}  // namespace

formats::Result<GlowErrorReport> check_glow(const formats::Scene& scene,
                                            const formats::AssetView& asset,
                                            const VolumeCheckOptions& options,
                                            const Context& context) {
    return check_emitted(with_black_surfaces(scene), asset, {}, options, context);
}

formats::Result<GlowErrorReport> check_lamps(const formats::Scene& scene,
                                             const formats::AssetView& asset, std::uint32_t first,
                                             const VolumeCheckOptions& options,
                                             const Context& context) {
    formats::Scene lit = scene;
    std::uint32_t emitters = first;
    for (formats::Volume& volume : lit.volumes) {
        volume.emission = {};
    }
    for (const formats::GlowRecord& record : asset.volumes.glow.record) {
        emitters = std::max(emitters, record.emitter + 1);
    }
    std::vector<formats::Rgb> color(emitters);
    std::fill(color.begin() + first, color.end(), formats::Rgb{1, 1, 1});
    return check_emitted(lit, asset, {.color = color}, options, context);
}

std::vector<double> march_glow(const formats::VolumesView& volumes, glm::dvec3 origin,
                               std::span<const VolumeProbe> probes, unsigned threads,
                               const runtime::EmitterLight& emitters) {
    std::vector<double> luminance(kLightPlaces * probes.size());
    const runtime::VolumeLight light = runtime::relight_volumes(
        volumes, {}, {.terms = formats::TermSet::none, .emitters = emitters, .threads = threads});
    const runtime::LitVolumes lit = runtime::light_volumes(volumes, light);
    for (std::size_t i = 0; i < luminance.size(); ++i) {
        const VolumeProbe& probe = probes[i % probes.size()];
        luminance[i] = luminance_along(lit, origin, probe.ray[i / probes.size()]);
    }
    return luminance;
}

std::vector<double> march_probes(const formats::VolumesView& volumes, std::uint32_t n,
                                 glm::dvec3 origin, std::span<const VolumeProbe> probes,
                                 unsigned threads) {
    std::vector<double> luminance(kLightPlaces * probes.size());
    const std::vector<formats::Environment> lights = make_volume_lights(probes);
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const runtime::LightVector vector = runtime::project_environment(lights[l], n, {}, threads);
        const runtime::VolumeLight lit = runtime::relight_volumes(
            volumes, vector, {.emitters = runtime::dark_emitters(), .threads = threads});
        const runtime::LitVolumes ready = runtime::light_volumes(volumes, lit);
        for (std::size_t p = 0; p < probes.size(); ++p) {
            for (std::size_t place = 0; place < kLightPlaces; ++place) {
                if (light_number(p, probes.size(), place) != l) continue;
                luminance[place * probes.size() + p] =
                    luminance_along(ready, origin, probes[p].ray[place]);
            }
        }
    }
    return luminance;
}

}  // namespace opaline::bake
