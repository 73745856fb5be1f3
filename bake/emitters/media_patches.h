#pragma once

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/lamps/receiver_light.h"
#include "bake/plan/row_layout.h"
#include "bake/receivers/receiver.h"
#include "bake/rows/medium_rows.h"
#include "formats/opal/asset.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Media of a scene, as the emitters' stages see them.
struct LitMedia {
    const FinishedMedia* finished = nullptr;  ///< null: there are none
    std::span<const RowLayout> layouts;       ///< by material
    std::span<const formats::Rgb> color;      ///< of all vertices of the file, without images
};

/// The receivers of one medium, of all its primitives.
struct LitMedium {
    std::uint32_t material = 0;
    std::vector<std::uint32_t> primitives;
    std::vector<std::uint32_t> first;  ///< of each primitive, its first receiver here
    std::vector<Receiver> outside;
    std::vector<BodyPoint> inside;
    std::vector<formats::Rgb> color;  ///< LitMedia::color
};

/// All media of a file that have rows of their own.
std::vector<LitMedium> list_lit_media(const LitMedia& media, std::span<const ReceiverSet> receivers,
                                      std::span<const formats::PrimitiveRecord> primitives);

/// Exitance at a receiver, color times sum_k g_k T_k, column by column. `row`: terms * 3 *
/// `columns` values. `weights`: weigh_rows_of_medium at the receiver.
std::vector<glm::vec3> exitance_of_row(std::span<const float> weights, formats::Rgb color,
                                       std::span<const float> row, std::size_t columns);

/// weigh_rows_of_medium at a receiver.
std::vector<float> weigh_rows_at(const LitMedia& media, const formats::Scene& scene,
                                 const LitMedium& medium, std::size_t receiver);

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
