#include "bake/effects/volumes/scattering_points.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

struct RayStep {
    float begin = 0, end = 0;  // [m]
    float density = 0;
    std::uint32_t volume = 0;
};

void append_steps(const DensityVolume& volume, std::uint32_t number, glm::vec3 from,
                  glm::vec3 direction, float reach, std::vector<RayStep>& steps) {
    const float voxels = glm::length(volume.to_index * direction);  // per metre
    visit_cells(
        volume, from, direction, reach, [&](float bound, float begin, float end, bool is_even) {
            const float count = std::max(1.0f, std::ceil((end - begin) * voxels));
            const float length = (end - begin) / count;
            for (float i = 0; i < count; ++i) {
                const float first = begin + i * length;
                const float density =
                    is_even ? bound : volume.density(from + (first + 0.5f * length) * direction);
                if (density > 0) {
                    steps.push_back({first, first + length, density, number});
                }
            }
            return true;
        });
}

// What a step scatters of light of radiance 1 around it, as much as arrives of it.
struct StepLight {
    std::array<float, 3> band{};
    float mean = 0;
};

std::vector<StepLight> light_steps(const DensitySpace& space, const std::vector<bool>& sends,
                                   std::span<const RayStep> steps) {
    std::vector<StepLight> light(steps.size());
    std::array<float, 3> through{1, 1, 1};
    const std::size_t bands = space.bands();
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const DensityVolume& volume = space.volumes[steps[i].volume];
        const float column = steps[i].density * (steps[i].end - steps[i].begin);
        for (std::size_t band = 0; band < bands; ++band) {
            const float lost = through[band] * -std::expm1(-column * volume.sigma_t[band]);
            through[band] -= lost;
            light[i].band[band] = sends[steps[i].volume] ? volume.albedo[band] * lost : 0;
            light[i].mean += light[i].band[band] / static_cast<float>(bands);
        }
    }
    return light;
}

}  // namespace

void find_scattering_points(const DensitySpace& space, const std::vector<bool>& sends,
                            glm::vec3 from, glm::vec3 direction, float reach, std::uint32_t count,
                            float shift, std::vector<ScatteringPoint>& points) {
    points.clear();
    std::vector<RayStep> steps;
    for (std::uint32_t v = 0; v < space.volumes.size(); ++v) {
        append_steps(space.volumes[v], v, from, direction, reach, steps);
    }
    if (space.volumes.size() > 1) {
        std::ranges::stable_sort(steps, {}, &RayStep::begin);
    }
    const std::vector<StepLight> light = light_steps(space, sends, steps);
    float all = 0;
    for (const StepLight& own : light) {
        all += own.mean;
    }
    if (!(all > 0)) return;
    const float part = all / static_cast<float>(count);
    float before = 0;  // light of the steps before
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const float own = light[i].mean;
        while (points.size() < count) {
            const float target = (static_cast<float>(points.size()) + shift) * part;
            if (!(own > 0) || target >= before + own) break;
            const float share = std::clamp((target - before) / own, 0.0f, 1.0f);
            ScatteringPoint point{
                from + (steps[i].begin + share * (steps[i].end - steps[i].begin)) * direction,
                steps[i].volume,
                {}};
            for (std::size_t band = 0; band < 3; ++band) {
                point.weight[band] = part * light[i].band[band] / own;
            }
            points.push_back(point);
        }
        before += own;
    }
}

}  // namespace opaline::bake
