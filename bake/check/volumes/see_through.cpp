#include "bake/check/volumes/see_through.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bake/check/volumes/volume_probes.h"
#include "formats/opal/rgb.h"
#include "runtime/light_vector.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"

namespace opaline::bake {
namespace {

const VolumeRay& even_ray(const VolumeProbe& probe) {
    return probe.ray[static_cast<std::size_t>(LightPlace::around)];
}

// Density times length [m] along a ray through one volume.
double column_of(const formats::Volume& volume, const VolumeRay& ray) {
    const auto& grid = volume.density;
    const glm::dmat4 to_index = glm::inverse(grid.to_scene);
    const glm::dvec3 from(to_index * glm::dvec4(glm::dvec3(ray.origin), 1));
    const glm::dvec3 along(to_index * glm::dvec4(glm::dvec3(ray.direction), 0));
    double begin = 0, end = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        constexpr int kSide = formats::SparseGrid<float>::kSide;
        const double low = kSide * grid.first_brick[axis] - 1,
                     high = kSide * (grid.first_brick[axis] + grid.extent[axis]);
        if (along[axis] != 0) {
            const double a = (low - from[axis]) / along[axis],
                         b = (high - from[axis]) / along[axis];
            begin = std::max(begin, std::min(a, b));
            end = std::min(end, std::max(a, b));
        } else if (from[axis] < low || from[axis] > high) {
            return 0;
        }
    }
    if (!(begin < end)) return 0;
    constexpr double kStepsOfVoxel = 4;
    const double count = std::ceil((end - begin) * glm::length(along) * kStepsOfVoxel);
    const double step = (end - begin) / count;
    double sum = 0;
    for (double i = 0; i < count; ++i) {
        sum +=
            static_cast<double>(grid.sample(glm::vec3(from + (begin + (i + 0.5) * step) * along)));
    }
    return sum * step;
}

}  // namespace

std::vector<double> see_through_scene(std::span<const formats::Volume> volumes,
                                      std::span<const VolumeProbe> probes) {
    std::vector<double> through;
    for (const VolumeProbe& probe : probes) {
        const VolumeRay& ray = even_ray(probe);
        glm::dvec3 depth(0);
        for (const formats::Volume& volume : volumes) {
            const formats::Rgb s = volume.sigma_t;
            depth += column_of(volume, ray) * glm::dvec3(s.r, s.g, s.b);
        }
        const glm::vec3 share(glm::exp(-depth));
        through.push_back(std::isinf(ray.end)
                              ? static_cast<double>(formats::luminance({share.x, share.y, share.z}))
                              : 0);
    }
    return through;
}

std::vector<double> see_through_file(const formats::VolumesView& volumes, std::uint32_t n,
                                     glm::dvec3 origin, std::span<const VolumeProbe> probes,
                                     unsigned threads) {
    const runtime::LightVector vector =
        runtime::project_environment(make_even_light(), n, {}, threads);
    const runtime::VolumeLight lit =
        runtime::relight_volumes(volumes, vector, {.threads = threads});
    const runtime::LitVolumes ready = runtime::light_volumes(volumes, lit);
    std::vector<double> through;
    for (const VolumeProbe& probe : probes) {
        const VolumeRay& ray = even_ray(probe);
        const glm::dvec3 from = origin + glm::dvec3(ray.origin);
        const auto to_vec3 = [](glm::dvec3 v) {
            return formats::Vec3{static_cast<float>(v.x), static_cast<float>(v.y),
                                 static_cast<float>(v.z)};
        };
        const runtime::MarchResult seen = runtime::march_volumes(
            ready,
            {to_vec3(from), to_vec3(glm::dvec3(ray.direction)), 0, static_cast<double>(ray.end)});
        through.push_back(
            std::isinf(ray.end) ? static_cast<double>(formats::luminance(seen.transmittance)) : 0);
    }
    return through;
}

}  // namespace opaline::bake
