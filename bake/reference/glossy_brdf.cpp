#include "bake/reference/glossy_brdf.h"

#include <algorithm>

#include "bake/reference/directional_albedo.h"
#include "bake/reference/ggx.h"

namespace opaline::bake {
namespace {

// Of one facet, seen under cosine o.h.
glm::dvec3 facet_reflectance(const GlossyBrdf& brdf, double o_h) {
    return brdf.f0 + (brdf.f90 - brdf.f0) * schlick_weight(o_h);
}

}  // namespace

GlossyBrdf make_glossy_brdf(const OpaqueSurface& surface, glm::vec3 normal, glm::vec3 to_eye) {
    GlossyBrdf brdf;
    brdf.frame = make_frame(normal);
    brdf.to_eye = into_frame(brdf.frame, to_eye);
    brdf.to_eye.z = std::max(brdf.to_eye.z, kGrazingCosine);
    brdf.to_eye = glm::normalize(brdf.to_eye);
    const double roughness{surface.roughness}, metallic{surface.metallic};
    const glm::dvec3 base_color(surface.base_color);
    brdf.alpha = ggx_alpha(roughness);
    brdf.f0 = glm::mix(glm::dvec3(surface.f0), base_color, metallic);
    brdf.f90 = glm::mix(glm::dvec3(surface.f90), glm::dvec3(1), metallic);
    const DirectionalAlbedo albedo = directional_albedo(brdf.to_eye.z, roughness);
    brdf.compensation = 1.0 + brdf.f0 * (1 / albedo.unit() - 1);
    const glm::dvec3 mirrored =
        (brdf.f0 * albedo.normal + brdf.f90 * albedo.grazing) * brdf.compensation;
    const double most = std::max({mirrored.x, mirrored.y, mirrored.z});
    brdf.mirrored_albedo = glm::vec3(mirrored);
    brdf.diffuse_albedo = glm::vec3(base_color * (1 - metallic) * std::max(0.0, 1 - most));
    return brdf;
}

std::optional<LobeSample> sample_mirrored(const GlossyBrdf& brdf, float u, float v) {
    const glm::dvec3& o = brdf.to_eye;
    const glm::dvec3 h = sample_visible_normal(o, brdf.alpha, double{u}, double{v});
    const double o_h = glm::dot(o, h);
    const glm::dvec3 l = glm::normalize(2 * o_h * h - o);
    if (!(o_h > 0) || !(l.z > 0)) return std::nullopt;
    LobeSample sample;
    sample.direction = glm::normalize(brdf.frame.to_world(glm::vec3(l)));
    sample.weight = glm::vec3(facet_reflectance(brdf, o_h) * brdf.compensation *
                              smith_shadowing(o.z, l.z, brdf.alpha));
    sample.pdf = static_cast<float>(pdf_visible_reflection(o.z, h, brdf.alpha));
    return sample;
}

LobeValue eval_mirrored(const GlossyBrdf& brdf, glm::vec3 to_light) {
    const glm::dvec3 l = into_frame(brdf.frame, to_light), &o = brdf.to_eye;
    if (!(l.z > 0)) {
        return {};
    }
    const glm::dvec3 h = glm::normalize(o + l);
    const double lobe = ggx_density(h, brdf.alpha) * smith_visibility(o.z, l.z, brdf.alpha) * l.z;
    return {glm::vec3(facet_reflectance(brdf, glm::dot(o, h)) * brdf.compensation * lobe),
            static_cast<float>(pdf_visible_reflection(o.z, h, brdf.alpha))};
}

}  // namespace opaline::bake
