#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/exchange/lamps/lamps.h"
#include "bake/exchange/lamps/point_box.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The stage of a bake that finds what volumes scatter of lamps' light.
inline constexpr const char* kLampsInVolumes = "light of emitters in volumes";

/// A lamp that is no volume, ready to be drawn from.
struct LitLamp {
    LampSources sources;
    std::vector<double> cumulative;  ///< power of its triangles, added up
    PointBox box;                    ///< around all but lights that have no place
};

LitLamp make_lit_lamp(const formats::Scene& scene, const Lamp& lamp);

/// What walks to light of lamps share, read-only.
struct LampWalkSpace {
    const DensitySpace& space;
    const formats::Scene& scene;  ///< of the surfaces
    const RayScene& rays;
    std::span<const LitLamp> lamps;
    std::uint64_t seed = 0;
};

/// A point at which the light of lamps that is scattered there is estimated.
struct LampReceiver {
    std::uint32_t volume = 0;
    std::size_t node = 0;      ///< the random numbers depend on it
    glm::vec3 position{0};     ///< [m]
    glm::mat3 spacing{1};      ///< [m] to the next nodes
    std::uint32_t walks = 64;  ///< W
    std::uint32_t terms = 1;   ///< K_e: 1, 4, 9, 16 or 25
};

/// E_k around a node (README.md, "Lamps"): coefficients of J by harmonics of the direction toward
/// the eye [nit], one for each lamp and term, lamp after lamp, overwritten.
struct LampLightAtNode {
    std::span<glm::vec3> straight;   ///< a mean over the tent to the next nodes
    std::span<glm::vec3> scattered;  ///< before, by volumes or surfaces; at the node
    std::span<glm::vec3> odd;        ///< the same by every other walk
};

/// Points around a node to which straight light is followed, where no lamp is near.
inline constexpr std::uint32_t kStraightPoints = 64;

/// Returns the rays traced.
std::uint64_t gather_lamps(const LampWalkSpace& walk, const LampReceiver& receiver,
                           const LampLightAtNode& out);

}  // namespace opaline::bake
