#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "bake/exchange/true_bounces.h"
#include "bake/lights/luminance.h"
#include "bake/plan/dense_rows.h"
#include "bake/plan/effect.h"

namespace opaline::bake {

struct LampBounces;  // lamp_bounces.h
struct PatchLight;   // exchange_points.h

/// Light that arrives at surfaces besides that of the distant environment, or instead of it: one
/// of the three. Its directions are not kept: effects take it for diffuse.
struct OtherLight {
    std::shared_ptr<const BounceLight> surfaces{};  ///< what these send
    const PatchLight* patches = nullptr;  ///< instead of the environment: a column for each patch
    const LampBounces* lamps = nullptr;   ///< instead of it: column e is lamp e
    /// 3, or 1 where the three coincide. With 3, rows of all receivers have three bands as well
    /// (RowLayout::coloured).
    std::uint32_t bands = 3;
    bool environment = true;  ///< that of the environment counts, too
    std::string_view name{};  ///< of the effect that makes it, for reports
    /// By material: 1 where it is not worth the rays. Empty: it is everywhere.
    std::vector<std::uint8_t> unreached{};
};

/// Whether light of the environment counts; `light` null: nothing else does.
inline bool has_environment(const OtherLight* light) {
    return light == nullptr || light->environment;
}

/// BakeInputs::light, or null where there is none that reaches the material.
inline const OtherLight* light_of(const EffectInputs& inputs) {
    const OtherLight* const light = inputs.bake.light;
    const bool reaches =
        light != nullptr && (light->unreached.empty() || light->unreached[inputs.material] == 0);
    return reaches ? light : nullptr;
}

/// Adds E(x), the irradiance per unit of each basis light, to `rows`: as many bands as `light` has
/// of 6 n n Haar coefficients of T's basis, n = `cubemap_size`; columns, where light replaces the
/// environment. Returns the rays traced. Any thread; the same bits for the same point.
std::uint64_t add_irradiance(const OtherLight& light, const LitPoint& point,
                             std::uint32_t cubemap_size, std::span<float> rows);

/// What a row takes of irradiance: radiance per irradiance, band by band.
struct OtherLightShare {
    std::uint32_t term = 0;
    std::array<float, 3> factor{};
};

/// Adds shares of the irradiance of `light` at a point to the rows of a receiver. Of light with
/// three bands a row of one band takes the luminance. Returns the rays traced: none where `light`
/// is null.
std::uint64_t add_other_light(const OtherLight* light, const Receiver& receiver,
                              std::initializer_list<OtherLightShare> shares, const DenseRow& row);

/// The truth of light_of(inputs), or none. `lights` must outlive it.
std::optional<BounceTruth> true_light_of(const EffectInputs& inputs,
                                         std::span<const TestLight> lights);

/// Adds share / pi of the true irradiance, two independent estimates, to those of the radiance of a
/// diffuse surface. Returns the rays.
std::uint64_t add_true_other_light(const std::optional<BounceTruth>& light,
                                   const Receiver& receiver, std::uint64_t key, double share,
                                   TwoEstimates& radiance);

}  // namespace opaline::bake
