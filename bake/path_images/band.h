#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "bake/path_integral/coefficients.h"
#include "bake/reference/volume_space.h"

namespace opaline::bake {

/// The coefficients of all volumes in channels that have the same [1/m where a density is 1].
struct MediumBand {
    std::array<double, formats::kMaxVolumes> scattering{}, extinction{};  ///< by volume
    std::array<bool, 3> channel{};                                        ///< that it stands for

    bool operator==(const MediumBand& other) const {
        return scattering == other.scattering && extinction == other.extinction;
    }
};

/// One band for a grey scene, else one for each set of equal channels.
std::vector<MediumBand> make_bands(const VolumeSpace& space);

/// The same medium without absorption.
MediumBand without_absorption(MediumBand band);

/// The sum of all volumes in a band, as the functions of path_integral/ take it. Refers to both.
struct BandMedium {
    const VolumeSpace& space;
    const MediumBand& band;

    Coefficients operator()(glm::dvec3 x) const {
        Coefficients sum;
        for (std::size_t v = 0; v < space.volumes.size(); ++v) {
            const auto density = static_cast<double>(space.volumes[v].density(glm::vec3(x)));
            sum.scattering += band.scattering[v] * density;
            sum.absorption += (band.extinction[v] - band.scattering[v]) * density;
        }
        return sum;
    }
};

}  // namespace opaline::bake
