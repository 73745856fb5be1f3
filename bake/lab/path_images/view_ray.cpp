#include "bake/lab/path_images/scattered_light.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

constexpr float kDeepest = 0.25f;  // optical depth of a step
constexpr float kMostSteps = 64;   // of a voxel, however dense

float steps_through(const VolumeSpace& space, const VolumeSegment& segment, glm::vec3 direction) {
    const float length = segment.end - segment.begin;
    float voxels = 1;
    for (std::size_t v = 0; v < space.volumes.size(); ++v) {
        if (segment.bound[v] > 0) {
            voxels = std::max(voxels, length * glm::length(space.volumes[v].to_index * direction));
        }
    }
    const float depth =
        length * std::max({segment.sigma_t.x, segment.sigma_t.y, segment.sigma_t.z});
    return std::ceil(std::clamp(depth / kDeepest, voxels, kMostSteps * voxels));
}

void add_step(const VolumeSpace& space, const MediumBand& band, std::span<const double> density,
              double ds, ViewBand& sum, double& absorbed) {
    double b = 0, c = 0;
    for (std::size_t v = 0; v < space.volumes.size(); ++v) {
        b += band.scattering[v] * density[v];
        c += band.extinction[v] * density[v];
    }
    ViewStep step;
    step.depth = b * ds;
    step.ell = sum.ell + 0.5 * b * ds;
    step.absorption = absorbed + 0.5 * (c - b) * ds;
    step.tau = sum.tau + 0.5 * c * ds;
    step.scattered = c > 0 ? std::exp(-sum.tau) * (b / c) * -std::expm1(-c * ds) : 0;
    sum.step.push_back(step);
    sum.ell += b * ds;
    sum.tau += c * ds;
    absorbed += (c - b) * ds;
}

}  // namespace

ViewRay march_view_ray(const VolumeSpace& space, std::span<const MediumBand> bands,
                       glm::vec3 origin, glm::vec3 direction, float reach) {
    ViewRay ray{origin, direction, 0, reach, {}, std::vector<ViewBand>(bands.size())};
    std::vector<double> absorbed(bands.size());
    std::array<double, formats::kMaxVolumes> density{};
    VolumeMarch march(space, origin, direction, reach);
    while (const auto segment = march.next()) {
        const float steps = steps_through(space, *segment, direction);
        const float ds = (segment->end - segment->begin) / steps;
        for (float i = 0; i < steps; ++i) {
            const glm::vec3 x = origin + (segment->begin + (i + 0.5f) * ds) * direction;
            double most = 0;
            for (std::size_t v = 0; v < space.volumes.size(); ++v) {
                density[v] =
                    segment->bound[v] > 0 ? static_cast<double>(space.volumes[v].density(x)) : 0.0;
                most = std::max(most, density[v]);
            }
            if (!(most > 0)) continue;
            if (ray.is_empty()) {
                ray.entry = segment->begin + i * ds;
            }
            ray.position.push_back(x);
            for (std::size_t k = 0; k < bands.size(); ++k) {
                add_step(space, bands[k], density, static_cast<double>(ds), ray.band[k],
                         absorbed[k]);
            }
        }
    }
    return ray;
}

}  // namespace opaline::bake
