#include "formats/media/load_albedo.h"

#include <algorithm>
#include <string>
#include <utility>

#include "formats/fill_grid.h"
#include "formats/gltf/report.h"
#include "formats/media/limits.h"
#include "formats/media/resampler.h"

namespace opaline::formats {
namespace {

using Albedos = SparseGrid<glm::vec3>;

// The least and the largest albedo of voxels with density.
struct AlbedoRange {
    glm::vec3 least{1}, most{0};

    void include(glm::vec3 albedo) {
        least = glm::min(least, albedo);
        most = glm::max(most, albedo);
    }
};

float largest_of(const VdbGrid& grid) {
    float most = 0;
    for (const float v : grid.scalar.value) {
        most = std::max(most, v);
    }
    for (const glm::vec3& v : grid.color.value) {
        most = std::max({most, v.x, v.y, v.z});
    }
    return most;
}

// Density times albedo at each voxel.
Albedos scatter(const SparseGrid<float>& density, const Resampler& albedo, AlbedoRange& range) {
    Albedos scattering;
    scattering.first_brick = density.first_brick;
    scattering.extent = density.extent;
    scattering.table = density.table;
    scattering.value.resize(density.value.size());
    for_bricks(density.first_brick, density.extent, [&](glm::ivec3 brick) {
        const std::uint32_t number = density.brick_at(brick);
        for (std::size_t i = 0; number != Albedos::kEmpty && i < Albedos::kBrickVoxels; ++i) {
            const std::size_t at = number * Albedos::kBrickVoxels + i;
            if (!(density.value[at] > 0)) continue;
            const glm::vec3 own = glm::min(albedo.at(voxel_of(brick, static_cast<int>(i))), 1.0f);
            range.include(own);
            scattering.value[at] = density.value[at] * own;
        }
    });
    return scattering;
}

}  // namespace

Status load_albedo(const VolumeEntry& entry, const std::filesystem::path& file,
                   const glm::dmat4& density_space, const VdbReadOptions& reader, Volume& volume,
                   std::vector<Diagnostic>& warnings) {
    if (entry.albedo_grid.empty()) return ok_status();
    const std::vector<std::string> names{entry.albedo_grid};
    auto read = read_vdb(file, names, reader);
    if (!read) return std::move(read).error();
    const VdbGrid& grid = read->front();
    warn_of_repairs(file, grid, warnings);
    if (!(largest_of(grid) <= 1 + media::kAlbedoRounding)) {
        return make_error(ErrorKind::bad_input, file.string(),
                          "grid " + gltf::in_quotes(entry.albedo_grid), "it holds albedos above 1",
                          "scale it to 0 ... 1");
    }
    const Resampler albedo(grid, density_space);
    warn_of_lost_detail(file, albedo, warnings);
    AlbedoRange range;
    Albedos scattering = scatter(volume.density, albedo, range);
    volume.albedo = {range.most.x, range.most.y, range.most.z};
    if (range.least != range.most) {
        volume.scattering = std::move(scattering);
    }
    return ok_status();
}

}  // namespace opaline::formats
