#include "bake/accuracy/volumes/volume_radiance.h"

#include "bake/accuracy/volumes/volume_lights.h"
#include "runtime/light_vector.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"

namespace opaline::bake {
namespace {

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

std::vector<double> march_glow(const formats::VolumesView& volumes, glm::dvec3 origin,
                               std::span<const VolumeProbe> probes, unsigned threads) {
    std::vector<double> luminance(kLightPlaces * probes.size());
    const runtime::VolumeLight light = runtime::relight_volumes(
        volumes, {}, {.terms = formats::TermSet::none, .threads = threads});
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
                if (light_number(p, probes.size(), place) != l) {
                    continue;
                }
                luminance[place * probes.size() + p] =
                    luminance_along(ready, origin, probes[p].ray[place]);
            }
        }
    }
    return luminance;
}

}  // namespace opaline::bake
