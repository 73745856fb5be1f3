#include "runtime/surface.h"

#include "formats/opal/thin_glass.h"
#include "runtime/gloss.h"
#include "runtime/texture.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

Rgb shade_translucent(const SurfaceMaterial& material, const SurfacePoint& point) {
    const float eta = material.primitive->eta;
    const MirroredShares mirrored =
        mirrored_shares(material.lobe, point.view, eta, point.open_axis, point.open_fraction);
    const Rgb inside = displayable((fresnel_transmittance(point.view.cosine, eta) + mirrored.own) *
                                   (point.radiance * point.base_color));
    if (material.lobe.radiance == nullptr) return inside;
    return displayable(inside + eval_specular(*material.light, material.lobe, point.view, eta,
                                              point.open_axis, point.open_fraction));
}

// What a metal mirrors of surfaces: of its lobe `blocked` meets them, and their mean radiance is
// what they send to the point over the part of its horizon that they cover.
Rgb mirrored_surfaces(const formats::GlossRecord& gloss, const formats::GlossSurface& surface,
                      const SurfacePoint& point, float blocked) {
    constexpr float kLeastCovered = 1.0f / 64;
    const float covered = 1 - point.open_fraction;
    if (gloss.metallic != 1 || gloss.image != formats::kNoImage || covered < kLeastCovered) {
        return {};
    }
    const Rgb albedo =
        formats::eval_gloss_albedo(surface, gloss_cosine(point.view.cosine)).specular;
    return blocked / covered * (albedo * point.radiance);
}

Rgb shade_gloss(const SurfaceMaterial& material, const SurfacePoint& point) {
    const formats::GlossSurface surface = formats::make_gloss_surface(
        *material.gloss, point.base_color, point.metallic, point.roughness);
    const float diffuse =
        formats::eval_gloss_albedo(surface, gloss_cosine(point.view.cosine)).diffuse;
    const Rgb reflected = displayable(diffuse * (point.radiance * point.base_color));
    if (material.light == nullptr) return reflected;
    const Rgb mirrored =
        eval_gloss(material.light->gloss, material.light->rotation, surface, point.view);
    const float visible =
        gloss_visibility(point.view, surface.roughness, point.open_axis, point.open_fraction);
    return displayable(reflected + visible * mirrored +
                       mirrored_surfaces(*material.gloss, surface, point, 1 - visible));
}

}  // namespace

SurfaceMaterial surface_material(const formats::AssetView& asset, std::size_t primitive,
                                 formats::TermSet terms, const SpecularLight* light,
                                 const EmitterLight& emitters) {
    SurfaceMaterial material;
    const auto number = static_cast<std::uint32_t>(primitive);
    material.own_radiance = own_radiance(asset.emitters, emitters, number);
    if (material.own_radiance != Rgb{}) material.own = asset.emitters.own_of(number);
    material.primitive = &asset.primitives[primitive];
    if (!asset.gloss.empty() && asset.gloss[primitive].is_glossy()) {
        material.gloss = &asset.gloss[primitive];
    }
    if (light != nullptr && has_any(terms, formats::TermSet::specular)) {
        material.light = light;
    }
    material.lobe = specular_lobe(material.light, asset, primitive);
    return material;
}

void set_gloss_factors(const formats::AssetView& asset, const SurfaceMaterial& material,
                       formats::Float2 texcoord, SurfacePoint& point) {
    const formats::GlossRecord& gloss = *material.gloss;
    point.metallic = gloss.metallic;
    point.roughness = gloss.roughness;
    if (gloss.image == formats::kNoImage) return;
    const Rgb values =
        sample_image_values(asset.images[gloss.image], texcoord, gloss.wrap_u, gloss.wrap_v);
    point.roughness *= values.g;
    point.metallic *= values.b;
}

void set_own_light(const formats::AssetView& asset, const SurfaceMaterial& material,
                   formats::Float2 texcoord, SurfacePoint& point) {
    point.own = material.own_radiance;
    if (material.own == nullptr || material.own->image == formats::kNoImage) return;
    point.own = point.own * sample_image_linear(asset.images[material.own->image], texcoord,
                                                material.own->wrap_u, material.own->wrap_v);
}

Rgb shade_surface(const SurfaceMaterial& material, const SurfacePoint& point) {
    const Rgb scattered = material.primitive->shading == formats::Shading::translucent
                              ? shade_translucent(material, point)
                          : material.gloss != nullptr
                              ? shade_gloss(material, point)
                              : displayable(point.radiance * point.base_color);
    return material.own == nullptr ? scattered : displayable(scattered + point.own);
}

float alpha_at(const formats::AssetView& asset, const formats::HoleRecord& hole,
               formats::Float2 texcoord, float vertex_alpha) {
    const float alpha = hole.alpha * vertex_alpha;
    return hole.image == formats::kNoImage
               ? alpha
               : alpha * sample_image_values(asset.images[hole.image], texcoord, hole.wrap_u,
                                             hole.wrap_v)
                             .r;
}

bool sees_surface(const formats::HoleRecord& hole, float alpha, const HoleSample& sample) {
    if (hole.mode == formats::HoleMode::mask) alpha = alpha >= hole.cutoff ? 1.0f : 0.0f;
    if (hole.clear != 0) {
        const formats::ClearShare clear = formats::clear_share_of(hole);
        alpha *= 1 - clear.share * formats::thin_glass_transmittance(sample.cosine, clear.eta);
    }
    // 1 / p and 1 / p^2 times 2^32, p^3 = p + 1; 2^32 over the golden ratio.
    const std::uint32_t place =
        0xc13fa9a9u * sample.column + 0x91e10da6u * sample.row + 0x9e3779b9u * sample.last_vertex;
    return static_cast<float>(place >> 8) < alpha * 0x1p24f;
}

}  // namespace opaline::runtime
