#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/lamps/glow_light.h"
#include "bake/lamps/lamp_sources.h"
#include "bake/lamps/media_light.h"
#include "bake/lamps/onward_ray.h"
#include "bake/lamps/surface_elements.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/ray_scene.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {

/// Rays average over many elements, which may be smaller and noisier than elements that are read
/// one by one.
inline constexpr JoinRule kGatheredElements{0.25, 0};
/// Paths of a caustic draw eight numbers or more, and the polygon of all their steps is far larger
/// than the distance of similar particles.
inline constexpr JoinRule kCausticElements{1.0 / 64, 16};

/// All lamps of a scene and the light that their particles brought to its surfaces.
struct LampLight {
    const formats::Scene& scene;
    const RayScene& rays;
    std::span<const LampSources> sources;  ///< of each lamp
    const ElementLayout& layout;
    /// Of each lamp; an empty one: no surface reflects its light.
    std::span<const ElementLight> elements;
    std::uint32_t samples = 1;  ///< shadow rays to a lamp, and gather rays
    std::uint64_t seed = 0;
    const MediaLight* media = nullptr;  ///< light that leaves media; null: none
    /// Reflected light is filtered over the cells of gather rays; null: colours of points.
    const ScenePyramids* textures = nullptr;
    /// Caustics of each lamp: light that only metals and media passed on; an empty one, or none:
    /// none.
    std::span<const ElementLight> caustics = {};
    const ElementLayout* caustic_layout = nullptr;  ///< their elements; null: `layout`
    const DensitySpace* volumes = nullptr;          ///< that dim light on its way; null: none
    /// Of each lamp, light of a volume; null, or an empty span: it is none.
    std::span<const std::unique_ptr<GlowLight>> glow = {};
};

/// Irradiance [lx] of a receiver from each lamp: straight, as metals and media pass it on from the
/// lamp, and from surfaces that `samples` rays spread by the cosine meet, mirrored by metals and
/// straight through media too: at their elements, or as media send it out. Light of volumes is
/// gathered by a quarter as many rays, 16 at least. (seed, key): key the rotation of these rays.
std::vector<glm::dvec3> receive_light(const LampLight& light, const Receiver& receiver,
                                      std::uint64_t key, std::uint64_t& rays);

/// Adds the caustics of each lamp at a receiver [lx] to `total`: the mean over the elements around
/// it.
void add_caustics(const LampLight& light, const Receiver& receiver, std::span<glm::dvec3> total,
                  std::uint64_t& rays);

/// Adds what the surface at a hit sends toward the ray, of every lamp, times pi and `weight`: by
/// its elements, or as media send it out; not what it emits or mirrors. `view`: footprint of
/// texture look-ups; null: at the point.
void add_reflected(const LampLight& light, const Arrival& at, const glm::dvec3& weight,
                   const TextureView* view, std::vector<glm::dvec3>& sum);

/// What a cone of directions [sr] sees of the surface at a hit, to look its textures up over; none
/// where these are points' or do not vary.
std::optional<TextureView> view_of_cone(const LampLight& light, const Arrival& at,
                                        const glm::vec3& direction, double solid_angle);

/// The rows of a set of opaque or thin-walled receivers: [lamp][row], outgoing radiance [nit]
/// without base colour, `terms` a receiver. Two terms: of the side of the normal, then of the other
/// one, as Shading::sheet has them.
std::vector<std::vector<formats::Rgb>> make_lamp_rows(const LampLight& light,
                                                      const ReceiverSet& set, std::uint32_t terms,
                                                      const Context& context, std::uint64_t& rays);

}  // namespace opaline::bake
