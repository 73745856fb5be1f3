#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/emitters/medium_answer.h"
#include "bake/emitters/receiver_light.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// The largest basis of patches, n of 6 n n, and the number of receivers that sample the surface.
inline constexpr std::uint32_t kPatchBasis = 8;
inline constexpr double kPatchPoints = 3 * 6 * kPatchBasis * kPatchBasis;

/// Patches of one medium's surface, and the exitance of all patches per irradiance on each.
struct MediumPatches {
    std::vector<std::uint32_t> of_receiver;          ///< of LitMedium
    std::vector<std::vector<std::uint32_t>> probes;  ///< of each patch, a few receivers: its light
    /// Exitance of patch `to` by irradiance 1 on patch `from`, band by band, without the base
    /// color's image: to * size() + from.
    std::vector<glm::vec3> answer;
    float mirrored = 0;  ///< share of diffuse light that the surface reflects from outside

    std::size_t size() const { return probes.size(); }
};

/// Cuts points into `most` patches, or as many as there are points: each time in halves along the
/// axis, of place or of normal, in which they differ most. The patch of each point. The two faces
/// of a thin wall are apart.
std::vector<std::uint32_t> cut_into_patches(std::span<const BodyPoint> points, std::size_t most);

/// One answer of a medium, at coarse settings, to light in a basis of patches. Empty where the
/// medium has no rows.
MediumPatches find_patches(const LitMedia& media, const LampLight& light, const LitMedium& medium,
                           const Context& context, std::uint64_t& rays);

/// Irradiance [lx] that `light` brings to each patch: lamp * size() + patch.
std::vector<glm::vec3> light_patches(const MediumPatches& patches, const LampLight& light,
                                     const LitMedium& medium, const Context& context,
                                     std::uint64_t& rays);

/// Exitance [lm/m^2] of each patch from that, with the light that its surface mirrors, taken as
/// diffuse.
std::vector<glm::vec3> answer_patches(const MediumPatches& patches,
                                      std::span<const glm::vec3> irradiance);

}  // namespace opaline::bake
