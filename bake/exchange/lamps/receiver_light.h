#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/exchange/lamps/glow_light.h"
#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/exchange/lamps/surface_elements.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Paths of a caustic draw eight numbers or more, and the polygon of all their steps is far larger
/// than the distance of similar particles.
inline constexpr JoinRule kCausticElements{1.0 / 64, 16};

/// All lamps of a scene and what metals and media pass on of their light.
struct LampLight {
    const formats::Scene& scene;
    const RayScene& rays;
    std::span<const LampSources> sources;  ///< of each lamp
    std::uint32_t samples = 1;             ///< shadow rays to a lamp
    std::uint64_t seed = 0;
    /// Caustics of each lamp: light that only metals and media passed on; an empty one, or none:
    /// none. Their elements.
    std::span<const ElementLight> caustics = {};
    const ElementLayout* layout = nullptr;
    const DensitySpace* volumes = nullptr;  ///< that dim light on its way; null: none
    /// Of each lamp, its light from volumes: what one sends out, or all scatter. An empty span:
    /// of no lamp.
    std::span<const std::optional<GlowLight>> glow = {};
    /// Of each lamp, what leaves the medium around it [lm/m^2], by elements of its outside; an
    /// empty one, or none: nothing. Their elements.
    std::span<const ElementLight> leaving = {};
    const ElementLayout* leaving_layout = nullptr;
    const ScenePyramids* textures = nullptr;  ///< filtered where views see them; null: at points
};

/// Irradiance [lx] of a receiver from each lamp, straight and as metals and media pass it on.
std::vector<glm::dvec3> receive_straight(const LampLight& light, const Receiver& receiver,
                                         std::uint64_t& rays);

/// Adds to the irradiance [lx] of each lamp what volumes send out or scatter of it, by a quarter as
/// many rays as to lamps, 16 at least. (seed, key): key their rotation.
void add_from_volumes(const LampLight& light, const Receiver& receiver, std::uint64_t key,
                      std::span<glm::dvec3> total, std::uint64_t& rays);

/// Adds the caustics of each lamp at a receiver [lx] to `total`: the mean over the elements around
/// it.
void add_caustics(const LampLight& light, const Receiver& receiver, std::span<glm::dvec3> total,
                  std::uint64_t& rays);

/// What leaves the medium of each lamp that is inside of one, at a receiver of its outside
/// [lm/m^2]: the mean over the elements around it.
std::vector<glm::dvec3> leaving_exitance(const LampLight& light, const Receiver& receiver,
                                         std::uint64_t& rays);

}  // namespace opaline::bake
