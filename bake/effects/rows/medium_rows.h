#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/rows/subject_states.h"
#include "bake/exchange/exchange_points.h"

namespace opaline::bake {

/// The knobs of media where a step toward a result needs their rows: KnobSpec::coarse, or those of
/// the coarsest preset, or `knobs` where these are coarser, with the choices of `knobs`.
Knobs coarse_knobs(const EffectTable& effects, const Knobs& knobs, std::uint32_t cubemap_size);

/// What effects say of the media of an exchange, at the knobs of the preset `draft` and its cube
/// map, because their light is smooth where it arrives. `bake`: without light of surfaces. The
/// subjects have been studied; they are left without samples.
std::vector<MediumRows> ask_media(const BakeInputs& bake, const Knobs& knobs,
                                  const Context& context, const ExchangePoints& points,
                                  std::vector<SubjectState>& subjects, std::uint64_t& rays);

/// Whether any effect turns light that replaces the environment into rows of a material.
bool takes_other_light(const EffectTable& effects, std::span<const PlanEntry> decisions,
                       const RowLayout& layout);

/// The layout of a medium's rows of light that replaces the environment: as in the file, in three
/// bands.
RowLayout lit_layout(RowLayout layout);

/// The media of a finished bake. `subjects`: studied.
struct FinishedMedia {
    const BakeInputs& bake;
    std::span<const PlanEntry> plan;
    const Knobs& knobs;
    std::vector<SubjectState>& subjects;
};

/// What a medium makes of light that arrives at its surface.
struct MediumRequest {
    std::uint32_t material = 0;
    std::span<const Receiver> outside;
    std::span<const BodyPoint> inside;
    const OtherLight& light;         ///< without the environment
    std::uint32_t cubemap_size = 1;  ///< of its basis
};

/// Rows of the points of a request by the effects of the plan: terms * 3 * 6 n n coefficients each.
/// None where the medium has no rows.
std::vector<std::vector<float>> light_medium(const FinishedMedia& media,
                                             const MediumRequest& request, const Context& context,
                                             std::uint64_t& rays);

/// The same of light that crosses the medium straight from lamps and what they light
/// (OtherLight::lamps), by the effects that let it cross. None where no such effect acts.
std::vector<std::vector<float>> light_through_medium(const FinishedMedia& media,
                                                     const MediumRequest& request,
                                                     const Context& context, std::uint64_t& rays);

/// Whether an effect of the plan lets light cross a medium straight.
bool lets_light_cross(const EffectTable& effects, std::span<const PlanEntry> decisions,
                      const RowLayout& layout);

}  // namespace opaline::bake
