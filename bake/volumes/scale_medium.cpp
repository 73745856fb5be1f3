#include "bake/volumes/scale_medium.h"

#include <algorithm>
#include <utility>

namespace opaline::bake {
namespace {

glm::vec3 to_vec3(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

std::array<float, 3> bands(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

// Weighted by density.
glm::vec3 mean_albedo(const formats::Volume& volume) {
    double density = 0;
    glm::dvec3 scattering(0);
    for (std::size_t i = 0; i < volume.density.value.size(); ++i) {
        density += static_cast<double>(volume.density.value[i]);
        scattering += glm::dvec3(volume.scattering.value[i]);
    }
    return density > 0 ? glm::vec3(scattering / density) : glm::vec3(0);
}

}  // namespace

ScaledMedium scale_medium(const formats::Volume& volume, double peak) {
    const glm::vec3 sigma_t = to_vec3(volume.sigma_t), albedo = to_vec3(volume.albedo);
    const auto f = static_cast<float>(peak);
    if (volume.scattering.empty() || f == 0) {
        return {bands(sigma_t * (1.0f - f * albedo)),
                bands(albedo * (1 - f) / (1.0f - f * albedo))};
    }
    const glm::vec3 left = 1.0f - f * mean_albedo(volume);
    auto grids = std::make_shared<ScaledGrids>();
    grids->density = volume.density;
    grids->scattering = volume.scattering;
    glm::vec3 largest(0);
    for (std::size_t i = 0; i < volume.density.value.size(); ++i) {
        const float density = volume.density.value[i];
        if (!(density > 0)) continue;
        const glm::vec3 own = glm::min(volume.scattering.value[i] / density, albedo);
        const glm::vec3 share = (1.0f - f * own) / left;
        const float scale = (share.x + share.y + share.z) / 3;
        const glm::vec3 scaled = glm::clamp(1.0f - (1.0f - own) / (left * scale), 0.0f, 1.0f);
        grids->density.value[i] = density * scale;
        grids->scattering.value[i] = density * scale * scaled;
        largest = glm::max(largest, scaled);
    }
    return {bands(sigma_t * left), bands(largest), std::move(grids)};
}

}  // namespace opaline::bake
