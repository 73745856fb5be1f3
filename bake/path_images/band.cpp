#include "bake/path_images/band.h"

#include <algorithm>

namespace opaline::bake {

std::vector<MediumBand> make_bands(const VolumeSpace& space) {
    std::vector<MediumBand> bands;
    for (int c = 0; c < 3; ++c) {
        MediumBand band;
        for (std::size_t v = 0; v < space.volumes.size(); ++v) {
            const TrackedVolume& volume = space.volumes[v];
            band.extinction[v] = static_cast<double>(volume.sigma_t[c]);
            const formats::Rgb albedo = volume.volume->albedo;
            band.scattering[v] = band.extinction[v] * static_cast<double>(c == 0   ? albedo.r
                                                                          : c == 1 ? albedo.g
                                                                                   : albedo.b);
        }
        auto same = std::find(bands.begin(), bands.end(), band);
        if (same == bands.end()) {
            same = bands.insert(bands.end(), band);
        }
        same->channel[static_cast<std::size_t>(c)] = true;
    }
    return bands;
}

MediumBand without_absorption(MediumBand band) {
    band.extinction = band.scattering;
    return band;
}

}  // namespace opaline::bake
