#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/interreflection/bounce_tree.h"
#include "bake/effects/interreflection/scatterers.h"
#include "bake/plan/effect.h"
#include "bake/transport/coded_rows.h"

namespace opaline::bake {

/// By band; of one band the first.
using BandColour = std::array<float, 3>;

/// What scatterers make of the environment's light and of each other's.
struct ScattererLight {
    std::uint32_t bands = 3;                    ///< or 1
    CodedRows emitted;                          ///< B without bounces, band by band, Haar
    std::vector<BandColour> reflect, transmit;  ///< of bounced light, on its side and through it
    std::vector<float> open_beyond;  ///< Scatterer::openness of the other side; of thin walls

    std::size_t row_size() const { return emitted.size(); }
};

/// Traces rays to the environment; sets Scatterer::openness. Counts `rays`.
ScattererLight light_scatterers(const LightInputs& inputs, std::span<Scatterer> scatterers,
                                std::uint32_t bands, std::uint64_t& rays);

}  // namespace opaline::bake
