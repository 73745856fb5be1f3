#pragma once

#include <array>
#include <glm/glm.hpp>

#include "bake/path_integral/coefficients.h"
#include "bake/path_integral/grid_medium.h"
#include "bake/volumes/density_space.h"

namespace opaline::bake {

/// All volumes together, as a medium of `path_integral/`. Paths turn by the scattering of the band
/// that scatters most; the coefficients of the other bands at the last queried point are kept.
class VolumeMedium {
  public:
    /// Refers to the space, which must stay.
    explicit VolumeMedium(const DensitySpace& space) : space_(space) {
        std::array<float, 3> most{};
        for (const DensityVolume& volume : space.volumes) {
            for (std::size_t band = 0; band < 3; ++band) {
                most[band] += volume.albedo[band] * volume.sigma_t[band];
            }
        }
        for (std::size_t band = 1; band < 3; ++band) {
            lead_ = most[band] > most[lead_] ? band : lead_;
        }
    }

    /// `x` [m] in the scene.
    Coefficients operator()(glm::dvec3 x) {
        here_ = {};
        for (const DensityVolume& volume : space_.volumes) {
            const auto density = static_cast<double>(volume.density(glm::vec3(x)));
            if (!(density > 0)) continue;
            const std::array<float, 3> albedo = volume.albedo_at(glm::vec3(x));
            for (std::size_t band = 0; band < space_.bands(); ++band) {
                const double extinction = density * static_cast<double>(volume.sigma_t[band]);
                const double scattering = extinction * static_cast<double>(albedo[band]);
                here_[band].scattering += scattering;
                here_[band].absorption += extinction - scattering;
            }
        }
        return here_[space_.bands() == 1 ? 0 : lead_];
    }

    /// Of each band of the space, where it was asked last.
    const std::array<Coefficients, 3>& here() const { return here_; }

  private:
    const DensitySpace& space_;
    std::size_t lead_ = 0;
    std::array<Coefficients, 3> here_{};
};

/// The box around all volumes: nothing is outside of it.
inline VolumeBox box_of(const DensitySpace& space) {
    VolumeBox box;
    for (std::size_t v = 0; v < space.volumes.size(); ++v) {
        const VolumeBox own = grid_box(*space.volumes[v].grid);
        box.low = v == 0 ? own.low : glm::min(box.low, own.low);
        box.high = v == 0 ? own.high : glm::max(box.high, own.high);
    }
    return box;
}

}  // namespace opaline::bake
