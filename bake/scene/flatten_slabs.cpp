#include "bake/scene/flatten_slabs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "bake/scattering/fresnel.h"
#include "bake/scattering/half_space_walk.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kPaths = 65536;  // standard error 0.002 at most

struct Flattened {
    formats::Sheet sheet;
    double straight = 0;  ///< of what enters: the most of any band
};

// Light enters with the share 1 - F_ext of what arrives. The gloss on top takes the rest, where
// there is one (ior > 1).
Flattened flatten(const formats::Medium& medium, const Context& context) {
    const auto eta = static_cast<double>(medium.eta);
    const double enters = 1 - fresnel_moments(eta).external;
    const double g = formats::mean_cosine(medium.phase);
    const std::array<float, 3> scattered{medium.sigma_s.r, medium.sigma_s.g, medium.sigma_s.b},
        absorbed{medium.sigma_a.r, medium.sigma_a.g, medium.sigma_a.b};
    Flattened found;
    const std::array<float*, 3> reflect{&found.sheet.reflect.r, &found.sheet.reflect.g,
                                        &found.sheet.reflect.b};
    const std::array<float*, 3> transmit{&found.sheet.transmit.r, &found.sheet.transmit.g,
                                         &found.sheet.transmit.b};
    for (std::size_t b = 0; b < 3; ++b) {
        const double sigma_s = static_cast<double>(scattered[b]),
                     sigma_t = sigma_s + static_cast<double>(absorbed[b]);
        SlabShares shares{{0, 0}, 0, enters};  // of a clear slab
        if (sigma_t > 0) {
            shares = walk_slab(sigma_s / sigma_t, g, eta,
                               sigma_t * static_cast<double>(medium.thickness), kPaths, 0, context);
        }
        const auto share = [&](double x) {
            return static_cast<float>(std::clamp(eta > 1 ? x / enters : x, 0.0, 1.0));
        };
        *reflect[b] = share(shares.once + shares.rest);
        *transmit[b] = share(shares.through);
        found.straight = std::max(found.straight, shares.straight / enters);
    }
    return found;
}

}  // namespace

std::vector<formats::Diagnostic> flatten_slabs(formats::Scene& scene, const Context& context) {
    constexpr double kWorthSaying = 0.02;
    std::vector<formats::Diagnostic> warnings;
    for (formats::Material& material : scene.materials) {
        if (!material.medium || !(material.medium->thickness > 0)) {
            continue;
        }
        const formats::Medium medium = *material.medium;
        const Flattened found = flatten(medium, context);
        material.medium.reset();
        material.sheet = found.sheet;
        material.double_sided = true;  // it has two sides
        material.gloss = {};
        if (medium.eta > 1) {
            material.gloss.specular = 1;
            material.gloss.roughness = medium.roughness;
            material.gloss.ior = medium.eta;
        }
        if (found.straight > kWorthSaying) {
            warnings.push_back(formats::make_warning(
                "", "material '" + material.name + "'",
                std::to_string(static_cast<int>(std::round(100 * found.straight))) +
                    " % of the light that enters passes the sheet unscattered, which is not "
                    "simulated",
                "make it thicker or denser, or accept that it is too dark against the light"));
        }
    }
    return warnings;
}

}  // namespace opaline::bake
