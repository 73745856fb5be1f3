#pragma once

#include <string>
#include <vector>

#include "formats/opal/environment.h"
#include "runtime/clouds/layer_light.h"

namespace opaline::runtime {

/// A light that the page offers, by the name that it shows.
struct PageLight {
    std::string name;
    formats::Environment environment;
};

/// What an asset needs of a light beside its radiance.
struct PageLightNeeds {
    std::vector<std::uint32_t> levels;  ///< SpecularNeeds
    bool gloss = false;
};

/// A script that hands a light to the page under the name `owner`, as the page projects and shows
/// it: as divide_light.h has it; what eyes see, at most 1024 x 512 pixels; cells and blurred maps
/// for gloss, if needed. Radiance is stored as halves times a scale: it errs by 2^-11 down to 1e-9
/// of the brightest pixel, that of the background by 2^-9.
/// `above`: where the asset has a cloud layer, this light above it at time 0: the page itself finds
/// what is below and what that needs.
std::string make_light_script(const std::string& owner, const PageLight& light,
                              const LayerLight* above, const PageLightNeeds& needs,
                              unsigned threads);

}  // namespace opaline::runtime
