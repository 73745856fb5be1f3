#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "bake/reference/phase_sampler.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A volume with bounds of its density, cell by cell. A cell is 8 voxels wide and begins, as a
/// brick does, at index coordinates that are multiples of 8.
struct TrackedVolume {
    const formats::Volume* volume = nullptr;
    glm::mat3 to_index{1};  ///< index = to_index * position + offset
    glm::vec3 offset{0};
    glm::ivec3 first{0}, extent{0};  ///< cells: the lowest one, and how many along each axis
    std::vector<float> bound;        ///< of the density in each cell, x fastest
    glm::vec3 sigma_t{0};
    PhaseSampler phase;

    float density(glm::vec3 position) const {
        return volume->density.sample(to_index * position + offset);
    }
    glm::vec3 albedo(glm::vec3 position) const {
        return volume->albedo_at(to_index * position + offset);
    }
};

/// The light that a volume sends out by itself, with the cells in which there is any.
struct GlowingVolume {
    const formats::SparseGrid<glm::vec3>* emission = nullptr;  ///< radiance per metre
    glm::mat3 to_index{1};  ///< index = to_index * position + offset
    glm::vec3 offset{0};
    glm::ivec3 first{0}, extent{0};  ///< cells, as those of TrackedVolume
    std::vector<bool> glows;         ///< each cell, x fastest

    glm::vec3 at(glm::vec3 position) const {
        return emission->sample(to_index * position + offset);
    }
};

/// All volumes of a scene, for flights of light.
struct VolumeSpace {
    std::vector<TrackedVolume> volumes;
    std::vector<GlowingVolume> glowing;  ///< those of them that do

    bool empty() const { return volumes.empty(); }
};

/// `scene` must outlive the result.
VolumeSpace make_volume_space(const formats::Scene& scene);

/// Part of a ray along which no bound of a density changes.
struct VolumeSegment {
    float begin = 0, end = 0;                         ///< [m] along the ray
    std::array<float, formats::kMaxVolumes> bound{};  ///< of the density of each volume
    glm::vec3 sigma_t{0};                             ///< [1/m] sum over volumes of bound * sigma_t
};

/// A ray through a lattice of cubes, cube by cube.
struct LatticeRay {
    glm::ivec3 cell{0}, step{0};
    glm::vec3 next{0}, pitch{0};  ///< where the ray meets the next plane of each axis, and how far
                                  ///< planes are apart [m]
    float begin = 0, end = 0;     ///< of the cell; end <= reach
    float reach = 0;              ///< [m]
    glm::ivec3 first{0}, extent{0};  ///< the cubes there are

    /// The ray o + t d from `from` on, in units of the lattice. False: it meets none of its cubes.
    bool start(glm::vec3 o, glm::vec3 d, float from, float to, glm::ivec3 lowest, glm::ivec3 count);
    /// To the next cube. False: there is none.
    bool advance();

  private:
    void find_end();
};

/// Walks a ray through all volumes, segment by segment, in order; those without density are left
/// out. Where cells are dense they are told apart voxel by voxel, so that possible collisions with
/// nothing stay few however dense a volume is.
class VolumeMarch {
  public:
    /// From 0 to `reach` [m], which may be infinite. `direction` is unit.
    VolumeMarch(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction, float reach);

    /// Nothing: the ray has left all volumes, or has reached its end.
    std::optional<VolumeSegment> next();

  private:
    // Where the ray is in a volume, or will enter it first.
    struct Cursor {
        glm::vec3 origin{0}, direction{0};  // in index coordinates, per metre
        LatticeRay cells, voxels;
        bool is_fine = false;  // the ray is followed through the voxels of its cell
        bool is_done = true;
        float begin = 0, end = 0;  // [m]
        float bound = 0;
    };
    void enter(std::size_t number, glm::vec3 from, glm::vec3 direction);
    void settle_in_cell(std::size_t number);
    static void settle_in_voxel(const TrackedVolume& volume, Cursor& cursor);
    void advance(std::size_t number);
    void skip_empty(std::size_t number);

    const VolumeSpace& space_;
    float reach_, at_ = 0;
    std::array<Cursor, formats::kMaxVolumes> cursor_;
};

}  // namespace opaline::bake
