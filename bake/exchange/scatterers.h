#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/exchange/surface_side.h"
#include "bake/plan/effect.h"
#include "bake/plan/surface_albedo.h"
#include "bake/receivers/surface_points.h"

namespace opaline::bake {

/// A place on one side of a surface.
struct SidePoint {
    glm::vec3 position{0};  ///< [m]
    SurfaceSide side;
};

/// Indices of at most `count` of the points, each near the middle of as many neighbours on its side
/// as the others have: as dense as all points are, and evenly spaced.
std::vector<std::uint32_t> choose_evenly(std::span<const SidePoint> points, std::size_t count);

/// A point of a surface that others see, on one of its sides.
struct Scatterer {
    glm::vec3 position{0}, normal{0};  ///< [m]; unit, of the facet, toward the side that is seen
    std::uint32_t material = 0;
    bool behind = false;  ///< the side that the facet's normal points away from
    Receiver outside;     ///< where light of that side is gathered
    Receiver beyond;      ///< the same of the other side; used of thin-walled surfaces
    BodyPoint inside;
    float openness = 0;    ///< share of the light of an even sky that reaches it, in [0, 1]
    SurfaceAlbedo albedo;  ///< with textures: mean over its cell

    /// What a narrow lobe mirrors on average of even light, in its largest band; 0 without one.
    float mirrored() const;
};
/// The running number of each scatterer among those with narrow lobes; formats::kNone of others.
std::vector<std::uint32_t> number_lobes(std::span<const Scatterer> scatterers);
/// How many of those numbers there are.
std::size_t count_lobes(std::span<const std::uint32_t> numbers);

/// A hit of a ray as a scatterer sees it, or nothing: the back of a surface that has none.
struct SeenSide {
    bool is_seen = false, behind = false;
    glm::vec3 normal{0};  ///< of the facet, toward the ray
    float cosine = 0;     ///< of the ray with it, > 0
};
/// `normal`: of the facet as it is wound, zero where it has none; `cosine` of the ray with it.
SeenSide side_of(const formats::Material& material, glm::vec3 normal, float cosine);
SeenSide side_of_hit(const formats::Scene& scene, const PacketHits& hits, std::size_t lane);

/// Rays that look for scatterers, of a scene with so many receivers.
double count_scatterer_rays(std::size_t receivers);

/// At most `count` scatterers where cosine-distributed rays of receivers end, and 1024 where those
/// of LightInputs::onlookers do: as dense as light from there is looked for. Only on materials
/// whose rows are filled. None where receivers see nothing. Counts `rays`.
std::vector<Scatterer> find_scatterers(const LightInputs& inputs, std::size_t count,
                                       std::uint64_t& rays);

/// `count` points uniform by area on the outsides of a material, seen by others or not; a pure
/// function of the scene, the material and the seed. None where it has no area.
std::vector<Scatterer> spread_over_material(const LightInputs& inputs, std::uint32_t material,
                                            std::size_t count);

}  // namespace opaline::bake
