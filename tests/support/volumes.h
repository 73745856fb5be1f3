#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "formats/fill_grid.h"
#include "formats/scene.h"

namespace opaline::tests {

/// A grid whose voxels have the value density(position of their centre [m]), over a box about the
/// scene's origin. `voxel` [m].
template <class Density>
formats::SparseGrid<float> sample_grid(glm::dvec3 half_size, double voxel, Density&& density) {
    const glm::ivec3 half(glm::ceil(half_size / voxel));
    return formats::fill_grid(-half, half, voxel,
                              [&](glm::ivec3 at) { return density(voxel * glm::dvec3(at)); });
}

/// exp(-r^2 / (2 size^2)), cut to zero at 4 sizes.
inline formats::SparseGrid<float> make_blob(double size, double voxel) {
    return sample_grid(glm::dvec3(4 * size), voxel, [size](glm::dvec3 p) {
        const double square = glm::dot(p, p) / (size * size);
        return square > 16 ? 0.0 : std::exp(-0.5 * square);
    });
}

/// 1 inside a ball; at its surface the share of the voxel inside, of a plane's.
inline formats::SparseGrid<float> make_ball_grid(double radius, double voxel) {
    return sample_grid(glm::dvec3(radius + voxel), voxel, [=](glm::dvec3 p) {
        return std::clamp(0.5 + (radius - glm::length(p)) / voxel, 0.0, 1.0);
    });
}

inline formats::Volume make_volume(formats::SparseGrid<float> density, float sigma_t, float albedo,
                                   float g) {
    formats::Volume volume;
    volume.name = "volume";
    volume.density = std::move(density);
    volume.sigma_t = {sigma_t, sigma_t, sigma_t};
    volume.albedo = {albedo, albedo, albedo};
    volume.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    volume.phase.g = g;
    return volume;
}

/// Gives each voxel the albedo that albedo(position of its centre [m]) says, a glm::vec3.
template <class Albedo>
void vary_albedo(formats::Volume& volume, Albedo&& albedo) {
    using Grid = formats::SparseGrid<float>;
    const Grid& density = volume.density;
    volume.scattering.first_brick = density.first_brick;
    volume.scattering.extent = density.extent;
    volume.scattering.table = density.table;
    volume.scattering.value.assign(density.value.size(), glm::vec3(0));
    glm::vec3 most(0);
    std::size_t cell = 0;
    glm::ivec3 b;
    for (b.z = 0; b.z < density.extent.z; ++b.z) {
        for (b.y = 0; b.y < density.extent.y; ++b.y) {
            for (b.x = 0; b.x < density.extent.x; ++b.x) {
                const std::uint32_t number = density.table[cell++];
                for (int i = 0; number != Grid::kEmpty && i < 512; ++i) {
                    const glm::ivec3 voxel = Grid::kSide * (density.first_brick + b) +
                                             glm::ivec3(i % 8, i / 8 % 8, i / 64);
                    const std::size_t at =
                        number * Grid::kBrickVoxels + static_cast<std::size_t>(i);
                    if (!(density.value[at] > 0)) continue;
                    const glm::vec3 own =
                        albedo(glm::dvec3(density.to_scene * glm::dvec4(glm::dvec3(voxel), 1)));
                    volume.scattering.value[at] = density.value[at] * own;
                    most = glm::max(most, own);
                }
            }
        }
    }
    volume.albedo = {most.x, most.y, most.z};
}

/// Makes a volume glow by its absorption, as matter in thermal equilibrium with light of radiance
/// `own` does: radiance per metre a L_e = (1 - albedo) sigma_t density L_e in every band and voxel.
inline void make_it_glow(formats::Volume& volume, glm::vec3 own) {
    const glm::vec3 albedo(volume.albedo.r, volume.albedo.g, volume.albedo.b);
    const glm::vec3 sigma_t(volume.sigma_t.r, volume.sigma_t.g, volume.sigma_t.b);
    const formats::SparseGrid<float>& density = volume.density;
    volume.emitter = "glow";
    volume.emission.first_brick = density.first_brick;
    volume.emission.extent = density.extent;
    volume.emission.table = density.table;
    volume.emission.value.clear();
    for (std::size_t i = 0; i < density.value.size(); ++i) {
        const float value = density.value[i];
        const glm::vec3 scattered =
            volume.scattering.empty() ? value * albedo : volume.scattering.value[i];
        volume.emission.value.push_back((value - scattered) * sigma_t * own);
    }
}

}  // namespace opaline::tests
