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

}  // namespace

std::vector<double> march_probes(const formats::VolumesView& volumes, std::uint32_t n,
                                 glm::dvec3 origin, std::span<const VolumeProbe> probes,
                                 unsigned threads) {
    std::vector<double> luminance(kLightPlaces * probes.size());
    const std::vector<formats::Environment> lights = make_volume_lights(probes);
    for (std::size_t l = 0; l < lights.size(); ++l) {
        const runtime::LightVector vector = runtime::project_environment(lights[l], n, {}, threads);
        const runtime::VolumeLight lit =
            runtime::relight_volumes(volumes, vector, {.threads = threads});
        const runtime::LitVolumes ready = runtime::light_volumes(volumes, lit);
        for (std::size_t p = 0; p < probes.size(); ++p) {
            for (std::size_t place = 0; place < kLightPlaces; ++place) {
                if (light_number(p, probes.size(), place) != l) {
                    continue;
                }
                const VolumeRay& ray = probes[p].ray[place];
                const runtime::MarchResult seen = runtime::march_volumes(
                    ready, {to_vec3(origin + glm::dvec3(ray.origin)),
                            to_vec3(glm::dvec3(ray.direction)), 0, static_cast<double>(ray.end)});
                luminance[place * probes.size() + p] =
                    static_cast<double>(formats::luminance(seen.radiance));
            }
        }
    }
    return luminance;
}

}  // namespace opaline::bake
