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

constexpr std::uint32_t kPaths = 16384;  // standard error 0.004 at most

struct Flattened {
    formats::Sheet sheet;
    double straight = 0;  ///< of what enters: the most of any band
};

// A slab whose walks have few events and that scatters light alike: one of many transport mean free
// paths does as the similar isotropic one, and beyond a hundred of them hardly any light gets
// through; the peak of an extremely forward phase function is light that goes straight on.
struct Slab {
    double albedo, g, thickness;
};
Slab shorten(Slab slab) {
    constexpr double kDiffuse = 2, kMost = 100, kMostForward = 0.99;
    const double absorbed = (1 - slab.albedo) * slab.thickness;
    double scattered = slab.albedo * slab.thickness;
    const double wanted =
        (1 - slab.g) * scattered > kDiffuse ? 0 : std::clamp(slab.g, -kMostForward, kMostForward);
    scattered *= (1 - slab.g) / (1 - wanted);
    const double thickness = scattered + absorbed;
    return {thickness > 0 ? scattered / thickness : 0, wanted, std::min(thickness, kMost)};
}

// What becomes of light in one band, as shares of what arrives.
SlabShares scatter(const formats::Medium& medium, double sigma_s, double sigma_a,
                   const Context& context) {
    const auto eta = static_cast<double>(medium.eta);
    const double sigma_t = sigma_s + sigma_a;
    if (!(sigma_t > 0)) {
        return {{0, 0}, 0, 1 - fresnel_moments(eta).external};
    }
    const Slab slab = shorten({sigma_s / sigma_t, formats::mean_cosine(medium.phase),
                               sigma_t * static_cast<double>(medium.thickness)});
    return walk_slab(slab.albedo, slab.g, eta, slab.thickness, kPaths, 0, context);
}

// Light enters with the share 1 - F_ext of what arrives. The gloss on top takes the rest; where
// there is none (ior < 1), the sheet reflects it diffusely.
Flattened flatten(const formats::Medium& medium, const Context& context) {
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
                             static_cast<double>(absorbed[b]), context);
        }
        const auto share = [&](double x) {
            return static_cast<float>(std::clamp(is_glossy ? x / (1 - outside) : x, 0.0, 1.0));
        };
        reflect[b] = share(shares.once + shares.rest + (is_glossy ? 0 : outside));
        transmit[b] = share(shares.through);
        found.straight = std::max(found.straight, shares.straight / (1 - outside));
    }
    found.sheet.reflect = {reflect[0], reflect[1], reflect[2]};
    found.sheet.transmit = {transmit[0], transmit[1], transmit[2]};
    return found;
}

}  // namespace

std::vector<formats::Diagnostic> flatten_slabs(formats::Scene& scene, const Context& context) {
    constexpr double kWorthSaying = 0.02;
    std::vector<formats::Diagnostic> warnings;
    for (formats::Material& material : scene.materials) {
        if (!material.medium || !(material.medium->thickness > 0)) continue;
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
