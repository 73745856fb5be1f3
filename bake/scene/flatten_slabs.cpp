#include "bake/scene/flatten_slabs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "bake/physics/fresnel.h"
#include "bake/physics/slab/even_light.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

struct Flattened {
    formats::Sheet sheet;
    double straight = 0;  ///< of what enters: the most of any band
};

// What becomes of light in one band, as shares of what arrives.
SlabShares scatter(const formats::Medium& medium, double sigma_s, double sigma_a) {
    const auto eta = static_cast<double>(medium.eta);
    const double sigma_t = sigma_s + sigma_a;
    if (!(sigma_t > 0)) return {.straight = 1 - fresnel_moments(eta).external};
    return share_even_light(sigma_s / sigma_t, formats::mean_cosine(medium.phase), eta,
                            sigma_t * static_cast<double>(medium.thickness));
}

// Light enters with the share 1 - F_ext of what arrives. The gloss on top takes the rest; where
// there is none (ior < 1), the sheet reflects it diffusely.
Flattened flatten(const formats::Medium& medium) {
    const double outside = fresnel_moments(static_cast<double>(medium.eta)).external;
    const bool is_glossy = medium.eta > 1;
    const std::array<float, 3> scattered{medium.sigma_s.r, medium.sigma_s.g, medium.sigma_s.b},
        absorbed{medium.sigma_a.r, medium.sigma_a.g, medium.sigma_a.b};
    std::array<float, 3> reflect{}, transmit{};
    Flattened found;
    SlabShares shares;
    for (std::size_t b = 0; b < 3; ++b) {
        if (b == 0 || scattered[b] != scattered[b - 1] || absorbed[b] != absorbed[b - 1]) {
            shares = scatter(medium, static_cast<double>(scattered[b]),
                             static_cast<double>(absorbed[b]));
        }
        const auto share = [&](double x) {
            return static_cast<float>(std::clamp(is_glossy ? x / (1 - outside) : x, 0.0, 1.0));
        };
        reflect[b] = share(shares.back + (is_glossy ? 0 : outside));
        transmit[b] = share(shares.through);
        found.straight = std::max(found.straight, shares.straight / (1 - outside));
    }
    found.sheet.reflect = {reflect[0], reflect[1], reflect[2]};
    found.sheet.transmit = {transmit[0], transmit[1], transmit[2]};
    return found;
}

}  // namespace

std::vector<formats::Diagnostic> flatten_slabs(formats::Scene& scene) {
    constexpr double kWorthSaying = 0.02;
    std::vector<formats::Diagnostic> warnings;
    for (formats::Material& material : scene.materials) {
        if (!material.medium || !(material.medium->thickness > 0)) continue;
        const formats::Medium medium = *material.medium;
        const Flattened found = flatten(medium);
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
