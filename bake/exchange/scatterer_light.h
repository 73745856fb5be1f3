#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/exchange/exchange_points.h"
#include "bake/exchange/medium_answer.h"
#include "bake/trace/coded_rows.h"

namespace opaline::bake {

/// What scatterers make of light that arrives, wherever it is from.
struct ScattererAnswers {
    std::vector<BandColour> reflect, transmit;  ///< on its side and through it; 0 of media
    std::vector<MediumAnswer> media;            ///< which reflect as these say
};

/// What scatterers make of the environment's light and of each other's.
struct ScattererLight {
    std::uint32_t bands = 3;  ///< or 1
    /// B without bounces, band by band, Haar; then E of scatterers with narrow lobes
    /// (number_lobes).
    CodedRows emitted;
    ScattererAnswers answers;
    std::vector<float> open_beyond;  ///< Scatterer::openness of the other side; of thin walls
    /// B of light of the sky that crosses a medium straight, but for the base colour; of scatterers
    /// on media that let some cross, else 0. No part of `emitted`.
    CodedRows crossing;

    std::size_t row_size() const { return emitted.size(); }
};

/// What an even sky makes of a plane of rows of flux (E or B), over that where all of the sky is
/// seen.
float even_share(std::span<const float> plane);

/// Traces rays to the environment; sets Scatterer::openness and takes the media of `points`, whose
/// rows are `media`. Counts `rays`.
ScattererLight light_scatterers(const LightInputs& inputs, ExchangePoints& points,
                                std::span<const MediumRows> media, std::uint32_t bands,
                                std::uint64_t& rays);

}  // namespace opaline::bake
