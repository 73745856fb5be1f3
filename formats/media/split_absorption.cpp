#include "formats/media/split_absorption.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace opaline::formats {
namespace {

constexpr float kSameHue = 1e-5f;  // rounding of a quotient, and some

float largest_of(glm::vec3 v) {
    return std::max({v.x, v.y, v.z});
}

float largest_albedo(const Volume& volume) {
    return std::max({volume.albedo.r, volume.albedo.g, volume.albedo.b});
}

// What is left of its albedos: one, if they differ no more.
void settle_albedo(Volume& volume) {
    glm::vec3 least(1), most(0);
    for (std::size_t i = 0; i < volume.density.value.size(); ++i) {
        if (!(volume.density.value[i] > 0)) continue;
        const glm::vec3 own = glm::min(volume.scattering.value[i] / volume.density.value[i], 1.0f);
        least = glm::min(least, own);
        most = glm::max(most, own);
    }
    volume.albedo = {most.x, most.y, most.z};
    if (largest_of(most - least) <= kSameHue) volume.scattering = {};
}

}  // namespace

std::optional<Volume> split_absorption(Volume& volume) {
    if (volume.scattering.empty()) return std::nullopt;
    const float largest = largest_albedo(volume);
    Volume absorber;
    absorber.name = volume.name + ", its absorption";
    absorber.density = volume.density;
    absorber.sigma_t = volume.sigma_t;
    absorber.albedo = {0, 0, 0};
    absorber.phase = volume.phase;
    bool absorbs = false;
    for (std::size_t i = 0; i < volume.density.value.size(); ++i) {
        float& density = volume.density.value[i];
        const float scatters = std::min(largest_of(volume.scattering.value[i]) / largest, density);
        absorber.density.value[i] = density - scatters;
        absorbs = absorbs || absorber.density.value[i] > kSameHue * density;
        density = scatters;
    }
    settle_albedo(volume);
    return absorbs ? std::optional(std::move(absorber)) : std::nullopt;
}

}  // namespace opaline::formats
