#pragma once

#include <cstdint>

#include "bake/effects/volumes/sent_light.h"
#include "bake/plan/dense_rows.h"
#include "bake/plan/knobs.h"
#include "bake/plan/row_layout.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Volumes before surfaces: they dim the light of the sky, and may scatter some to surfaces.
struct VolumesBefore {
    DensitySpace space;
    LightCells cells;                 ///< directions in which they are looked through
    const SentLight* sent = nullptr;  ///< what they scatter; null: nothing
};
/// `scene`, with its volumes, must outlive it.
VolumesBefore make_volumes_before(const formats::Scene& scene, const Knobs& knobs,
                                  const SentLight* sent);

/// What a row answers to irradiance on either side of its receiver: radiance per irradiance.
struct AnswerToSent {
    float front = 0, back = 0;
};
/// Of term `term` of an opaque or thin-walled surface in one of `bands` bands.
AnswerToSent answer_of_surface(const formats::Material& material, std::uint32_t term,
                               std::uint32_t band, std::uint32_t bands);
/// Of a row of a medium that answers `even` to an even sky of radiance 1, where `open` is the share
/// of its hemisphere in which no surface is met: as to that sky, for each unit of irradiance. In
/// hollows much of that is light of other walls or through them: `most`, the largest answer of the
/// receiver's rows, would exceed 1 if it were all of light that arrives there, so that it is 1.
AnswerToSent answer_of_medium(double even, float open, double most);

/// Multiplies the dense rows of a receiver by the transmittance of volumes from each direction to
/// it, and adds the light that they scatter to it. Exact for light that a surface reflects; light
/// that enters a body is assumed to enter where it leaves. Scattered light is assumed to be even
/// over the mean free path of a body. Any thread; returns the rays traced.
std::uint64_t complete_row(const VolumesBefore& volumes, const formats::Material& material,
                           const RowLayout& layout, const GatherReceiver& receiver,
                           const DenseRow& row);

}  // namespace opaline::bake
