#include "bake/reference/glossy_brdf.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bake/reference/ggx.h"

namespace opaline::bake {
namespace {

// Even in the cube root of the cosine: the albedo changes fast near grazing.
constexpr std::size_t kCosines = 64, kRoughnesses = 64;
constexpr int kSteps = 32;
const double kLeastRoot = std::cbrt(kGrazingCosine);

struct Table {
    std::vector<DirectionalAlbedo> node;  ///< by roughness, then cosine

    Table() {
        node.reserve(kCosines * kRoughnesses);
        for (std::size_t r = 0; r < kRoughnesses; ++r) {
            for (std::size_t c = 0; c < kCosines; ++c) {
                const double root = kLeastRoot + (1 - kLeastRoot) * static_cast<double>(c) /
                                                     static_cast<double>(kCosines - 1);
                const double roughness =
                    static_cast<double>(r) / static_cast<double>(kRoughnesses - 1);
                node.push_back(
                    integrate_albedo(std::min(1.0, root * root * root), roughness, kSteps));
            }
        }
    }
};

// Between nodes i and i + 1 of `count`, at `t` of the way.
struct Place {
    std::size_t i;
    double t;
};
Place find_place(double share, std::size_t count) {
    const double x = std::clamp(share, 0.0, 1.0) * static_cast<double>(count - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(x), count - 2);
    return {i, x - static_cast<double>(i)};
}

DirectionalAlbedo mix(const DirectionalAlbedo& a, const DirectionalAlbedo& b, double t) {
    return {a.normal + t * (b.normal - a.normal), a.grazing + t * (b.grazing - a.grazing)};
}

// Of one facet, seen under cosine o.h.
glm::dvec3 facet_reflectance(const GlossyBrdf& brdf, double o_h) {
    return brdf.f0 + (brdf.f90 - brdf.f0) * schlick_weight(o_h);
}

}  // namespace

DirectionalAlbedo integrate_albedo(double cosine, double roughness, int steps) {
    const double alpha = ggx_alpha(roughness);
    const glm::dvec3 o(std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine);
    DirectionalAlbedo sum;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            // Crowded at the rim, u = 1 - (1 - s)^2, where the steepest normals are. v is a half
            // turn from -90 degrees: the plane of o and the normal is a mirror.
            const double rest = 1 - (i + 0.5) / steps, u = 1 - rest * rest;
            const double v = 0.5 * (j + 0.5) / steps - 0.25;
            const glm::dvec3 h = sample_visible_normal(o, alpha, u, v);
            const double o_h = glm::dot(o, h), c_l = 2 * o_h * h.z - o.z;
            if (c_l > 0) {
                const double kept = 2 * rest * smith_shadowing(cosine, c_l, alpha);
                const double weight = schlick_weight(o_h);
                sum.normal += (1 - weight) * kept;
                sum.grazing += weight * kept;
            }
        }
    }
    const double count = static_cast<double>(steps) * steps;
    return {sum.normal / count, sum.grazing / count};
}

DirectionalAlbedo directional_albedo(double cosine, double roughness) {
    static const Table table;
    const Place c = find_place(
        (std::cbrt(std::max(cosine, kGrazingCosine)) - kLeastRoot) / (1 - kLeastRoot), kCosines);
    const Place r = find_place(roughness, kRoughnesses);
    const DirectionalAlbedo* row = &table.node[r.i * kCosines + c.i];
    const DirectionalAlbedo* next = row + kCosines;
    return mix(mix(row[0], row[1], c.t), mix(next[0], next[1], c.t), r.t);
}

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
