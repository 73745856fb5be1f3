#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/volumes/node_lattice.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/volumes.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Volumes that are baked, as surfaces see them. What `make_sent_light` is given must outlive it.
struct SentLight {
    const RayScene& rays;
    formats::VolumesView baked;
    DensitySpace space;
    std::vector<NodeLattice> lattices;  ///< by volume of the scene
    std::vector<std::uint32_t> record;  ///< by volume: number among those of the file, or kNone
    std::vector<bool> sends;            ///< by volume
    LightCells cells;                   ///< of irradiance: coarse, since much of a volume is seen
    std::vector<float> harmonic;        ///< Y_k of the cells, k after k
    std::vector<std::uint16_t> coarse;  ///< by coefficient of a row: that of the cells, or none
    std::uint32_t side = 0;             ///< rays of a receiver, square root
    std::uint64_t seed = 0;

    static constexpr std::uint16_t kFiner = 0xffff;
    std::size_t bands() const { return space.bands(); }
    std::size_t row_size() const { return bands() * cells.size(); }
};

/// `layouts`: those of `baked`, in order; volumes of which VolumeLayout::lights_surfaces is set
/// send light.
SentLight make_sent_light(const formats::Scene& scene, const RayScene& rays,
                          std::span<const VolumeLayout> layouts, const formats::VolumesView& baked,
                          const Knobs& knobs);

/// Rays of a receiver in a bake of some quality, and points along each.
std::uint32_t count_sent_light_rays(Quality quality);
inline constexpr std::uint32_t kPointsOfSentRay = 4;

/// Light that volumes scatter to a receiver.
struct SentIrradiance {
    /// Irradiance [W m^-2] per unit of light [W m^-2] from each cell: SentLight::row_size values,
    /// band after band; zeros without a normal.
    std::vector<float> rows;
    float open = 0;  ///< share of cosine-weighted directions in which no surface is met
    std::uint64_t rays = 0;
};

/// E(x) = int cos J e^-tau b dt dw over the hemisphere up to the first surface: rays in a square
/// grid of cells of equal cosine-weighted solid angle, points along them
/// (`find_scattering_points`), and one of the eight nodes around each by its weight there. Random
/// numbers are keyed by place and normal. Any thread; the same bits for the same point.
SentIrradiance gather_sent_light(const SentLight& light, const Receiver& at);

}  // namespace opaline::bake
