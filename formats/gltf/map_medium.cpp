#include "formats/gltf/map_medium.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/gltf/clamp_factor.h"

namespace opaline::formats::gltf {

namespace {

using Remarks = std::vector<std::string>;

constexpr double kMaxAnisotropy = 0.99, kMinEta = 1.0 / 3.0, kMaxEta = 3.0;

constexpr const char* kNoDistance =
    "attenuationDistance is not above 0, which makes the medium infinitely dense: the surface is "
    "baked diffuse (set it above 0)";

/// Why the extensions describe no scattering medium; empty where they do.
std::string obstacle(const TranslucencySource& source) {
    if (source.has_scatter && !source.scatter_strength) {
        return "scatterStrengthFactor is absent and 0 by default, which switches scattering off: "
               "the surface is baked diffuse (set it to 1)";
    }
    if (source.has_scatter && !(*source.scatter_strength > 0.0)) {
        return "scatterStrengthFactor is 0, which switches scattering off: the surface is baked "
               "diffuse";
    }
    if (is_black(source.multiscatter_color)) {
        return "the multiscatter colour is black, so that nothing scatters: the surface is baked "
               "diffuse";
    }
    const bool lets_in = source.transmission > 0.0 ||
                         (source.has_volume_scatter && source.diffuse_transmission > 0.0);
    if (!lets_in) {
        return "transmissionFactor is 0, so that no light enters the scattering medium: the "
               "surface is baked diffuse (set it to 1)";
    }
    if (!(source.attenuation_distance > 0.0)) return kNoDistance;
    if (!std::isfinite(source.attenuation_distance)) {
        return "attenuationDistance is absent and infinite by default, so that nothing scatters: "
               "the surface is baked diffuse (set it)";
    }
    if (glm::all(glm::greaterThanEqual(source.attenuation_color, glm::dvec3(1.0)))) {
        return "attenuationColor is white, so that nothing scatters: the surface is baked diffuse "
               "(darken it)";
    }
    return {};
}

double relative_ior(const TranslucencySource& source, Remarks& remarks) {
    if (source.has_ior && source.ior == 0.0) {
        remarks.push_back("ior 0 (total reflection) is not simulated: 1.5 is used");
        return 1.5;
    }
    return clamp_factor(source.ior, 1.0, kMaxEta, "ior", remarks);
}

/// A medium has one number for its boundary, so the reflectance at normal incidence that ior and
/// specular ask for together, F0 = min(((ior - 1)/(ior + 1))^2 colour, 1) factor, is turned back
/// into an index: eta = (1 + sqrt F0) / (1 - sqrt F0).
double boundary_eta(const TranslucencySource& source, Remarks& remarks) {
    const double ior = relative_ior(source, remarks);
    if (!source.has_specular ||
        (source.specular == 1.0 && source.specular_color == glm::dvec3(1.0))) {
        return ior;
    }
    const double factor = clamp_factor(source.specular, 0.0, 1.0, "specularFactor", remarks);
    const glm::dvec3 color = glm::max(source.specular_color, 0.0);
    if (color.x != color.y || color.y != color.z) {
        remarks.push_back("a coloured specularColorFactor is not simulated: its luminance is used");
    }
    const double normal = (ior - 1.0) / (ior + 1.0);
    const glm::dvec3 reflected = factor * glm::min(normal * normal * color, glm::dvec3(1.0));
    const double root = std::sqrt(glm::dot(reflected, glm::dvec3(0.2126, 0.7152, 0.0722)));
    // A reflectance above that of eta = 3 also gives a quotient above 3, which is clamped.
    const double eta = root < 1.0 ? (1.0 + root) / (1.0 - root) : kMaxEta;
    return std::clamp(eta, kMinEta, kMaxEta);
}

void remark_losses(const TranslucencySource& source, Remarks& remarks) {
    if (source.transmission > 0.0 && source.transmission < 1.0) {
        remarks.push_back("transmissionFactor below 1 is not simulated: it is taken as 1");
    }
    if (source.diffuse_transmission > 0.0) {
        remarks.push_back(
            source.has_scatter
                ? "diffuseTransmissionFactor contradicts scattering inside and is not used"
                : "the diffuse lobe of diffuseTransmissionFactor is not simulated: light enters by "
                  "refraction");
    }
    if (source.diffuse_transmission > 0.0 && source.diffuse_transmission_color != glm::dvec3(1.0)) {
        remarks.push_back("diffuseTransmissionColorFactor is not simulated");
    }
    for (const std::string& texture : source.textures) {
        remarks.push_back(texture + " is not simulated: the factor is used alone");
    }
}

void finish_surface(const TranslucencySource& source, Medium& medium, Remarks& remarks) {
    medium.eta = static_cast<float>(boundary_eta(source, remarks));
    medium.roughness =
        static_cast<float>(clamp_factor(source.roughness, 0.0, 1.0, "roughnessFactor", remarks));
    remark_losses(source, remarks);
}

/// Absorption alone, or nothing inside; nothing where the surface lets no light in.
std::optional<Medium> map_glass(const TranslucencySource& source, double metres_per_unit,
                                Remarks& remarks) {
    const bool has_inside = source.has_volume && source.thickness > 0.0;
    if (!has_inside || !(source.transmission > 0.0)) return std::nullopt;
    if (!(source.attenuation_distance > 0.0)) {
        remarks.emplace_back(kNoDistance);
        return std::nullopt;
    }
    const glm::dvec3 kept = clamp_color(source.attenuation_color, "attenuationColor", remarks);
    const double metres = source.attenuation_distance * metres_per_unit;
    const auto absorption = [&](double color) {
        constexpr double kClearest = 1e-15, kDensest = 1e15;  // [1/m]: float keeps its products
        constexpr double kTiny = std::numeric_limits<float>::min();
        return static_cast<float>(
            std::clamp(-std::log(std::max(color, kTiny)) / metres, kClearest, kDensest));
    };
    Medium medium;
    medium.sigma_s = {0, 0, 0};
    medium.sigma_a = {absorption(kept.x), absorption(kept.y), absorption(kept.z)};
    finish_surface(source, medium, remarks);
    return medium;
}

}  // namespace

double single_scattering_albedo(double multiscatter, double g) {
    if (!(multiscatter > 0.0)) return 0.0;
    const double root =
        std::sqrt(9.59217 + 41.6808 * multiscatter + 17.7126 * multiscatter * multiscatter);
    // The constants are rounded: white comes out as s = -5e-6.
    const double s = std::clamp(4.09712 + 4.20863 * multiscatter - root, 0.0, 1.0);
    return (1.0 - s * s) / (1.0 - g * s * s);
}

std::optional<Medium> map_medium(const TranslucencySource& source, double metres_per_unit,
                                 Remarks& remarks) {
    if (!source.has_scatter && !source.has_volume_scatter) {
        return map_glass(source, metres_per_unit, remarks);
    }
    if (std::string why = obstacle(source); !why.empty()) {
        remarks.push_back(std::move(why));
        return std::nullopt;
    }
    const double strength = source.has_scatter ? clamp_factor(*source.scatter_strength, 0.0, 1.0,
                                                              "scatterStrengthFactor", remarks)
                                               : 1.0;
    const double g = clamp_factor(source.anisotropy, -kMaxAnisotropy, kMaxAnisotropy,
                                  "scatterAnisotropy", remarks);
    const glm::dvec3 color =
        clamp_color(source.multiscatter_color, "the multiscatter colour", remarks);
    const glm::dvec3 kept = clamp_color(source.attenuation_color, "attenuationColor", remarks);
    const double metres = source.attenuation_distance * metres_per_unit;
    glm::dvec3 scattering, absorption;
    double greatest = 0.0;
    for (int band = 0; band < 3; ++band) {
        constexpr double kTiny =
            std::numeric_limits<float>::min();  // black would be infinitely dense
        const double sigma_t = -std::log(std::max(kept[band], kTiny)) / metres;
        const double albedo =
            single_scattering_albedo(strength * color[band], source.has_scatter ? g : 0.0);
        greatest = std::max(greatest, sigma_t);
        scattering[band] = sigma_t * albedo;
        absorption[band] = sigma_t * (1.0 - albedo);
    }
    constexpr double kDensest = 1e15,
                     kThinnest = 1e-15;  // [1/m]: single precision keeps its products
    if (!(greatest <= kDensest && greatest >= kThinnest)) {
        remarks.push_back(
            "attenuationDistance is so extreme that there is no such medium: the surface "
            "is baked diffuse (set it to the scale of the object)");
        return std::nullopt;
    }
    Medium medium;
    medium.sigma_s = to_rgb(scattering);
    medium.sigma_a = to_rgb(absorption);
    if (g != 0.0) {
        medium.phase.type = PhaseFunction::Type::henyey_greenstein;
        medium.phase.g = static_cast<float>(g);
    }
    finish_surface(source, medium, remarks);
    return medium;
}

}  // namespace opaline::formats::gltf
