#include "bake/trace/density/density_space.h"

#include <limits>
#include <utility>

#include "bake/trace/density/grid_loops.h"

namespace opaline::bake {
namespace {

using Grid = formats::SparseGrid<float>;

float densest_followed(const Grid& grid, const std::array<float, 3>& sigma_t) {
    const float most = std::max({sigma_t[0], sigma_t[1], sigma_t[2]});
    const double edge = std::min({glm::length(glm::dvec3(grid.to_scene[0])),
                                  glm::length(glm::dvec3(grid.to_scene[1])),
                                  glm::length(glm::dvec3(grid.to_scene[2]))});
    const double density = static_cast<double>(kMostDepth) / (static_cast<double>(most) * edge);
    return static_cast<float>(std::min(density, 1e30));
}

DensityVolume make_volume(const formats::Volume& volume) {
    DensityVolume own;
    own.phase = scale_phase(volume.phase);
    ScaledMedium medium = scale_medium(volume, own.phase.peak);
    own.sigma_t = medium.sigma_t;
    own.albedo = medium.albedo;
    own.scaled = std::move(medium.grids);
    own.grid = own.scaled ? &own.scaled->density : &volume.density;
    if (!volume.scattering.empty()) {
        own.scattering = own.scaled ? &own.scaled->scattering : &volume.scattering;
    }
    place_cells(volume.density, volume.density.to_scene, own);
    own.densest = densest_followed(*own.grid, own.sigma_t);
    for_each_point(glm::ivec3(0), own.extent, [&](glm::ivec3 cell) {
        float least = std::numeric_limits<float>::infinity(), most = 0;
        for_each_voxel_of_cell(*own.grid, own.first_cell + cell, [&](float value) {
            least = std::min(least, value);
            most = std::max(most, value);
        });
        own.bound.push_back(std::min(most, own.densest));
        own.even.push_back(most > 0 && least >= own.bound.back());
    });
    return own;
}

bool is_grey(const std::array<float, 3>& band) {
    return band[0] == band[1] && band[1] == band[2];
}

bool has_grey_albedo(const DensityVolume& volume) {
    return is_grey(volume.albedo) &&
           (volume.scattering == nullptr ||
            std::ranges::all_of(volume.scattering->value,
                                [](glm::vec3 v) { return v.x == v.y && v.y == v.z; }));
}

}  // namespace

DensitySpace make_density_space(const formats::Scene& scene) {
    DensitySpace space;
    for (const formats::Volume& volume : scene.volumes) {
        space.volumes.push_back(make_volume(volume));
        space.is_grey = space.is_grey && is_grey(space.volumes.back().sigma_t);
        space.light_grey = space.light_grey && has_grey_albedo(space.volumes.back());
    }
    return space;
}

double even_share(const DensityVolume& volume) {
    double dense = 0, even = 0;
    for (std::size_t cell = 0; cell < volume.bound.size(); ++cell) {
        dense += volume.bound[cell] > 0 ? 1 : 0;
        even += volume.even[cell] ? 1 : 0;
    }
    return dense > 0 ? even / dense : 0;
}

std::array<float, 3> optical_depth(const DensitySpace& space, glm::vec3 from, glm::vec3 direction,
                                   float reach) {
    std::array<float, 3> depth{};
    for (const DensityVolume& volume : space.volumes) {
        const float voxels_per_metre = glm::length(volume.to_index * direction);
        float column = 0;
        visit_cells(volume, from, direction, reach,
                    [&](float bound, float begin, float end, bool is_even) {
                        if (is_even) {
                            column += bound * (end - begin);
                            return true;
                        }
                        const float steps = std::ceil((end - begin) * voxels_per_metre);
                        const float ds = (end - begin) / std::max(steps, 1.0f);
                        float sum = 0;
                        for (float i = 0; i < steps; ++i) {
                            sum += volume.density(from + (begin + (i + 0.5f) * ds) * direction);
                        }
                        column += sum * ds;
                        return true;
                    });
        for (std::size_t band = 0; band < 3; ++band) {
            depth[band] += volume.sigma_t[band] * column;
        }
    }
    return depth;
}

}  // namespace opaline::bake
