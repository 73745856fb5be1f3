#include "bake/reference/rough_boundary.h"

#include <algorithm>
#include <cmath>

#include "bake/reference/ggx.h"
#include "bake/reference/glossy_brdf.h"

namespace opaline::bake {
namespace {

// What a facet does with light that it meets under the cosine c.
struct Facet {
    double reflectance = 1;
    double along = 0;  ///< refracted ray: -o / ratio + along * h; unset under total reflection
};
Facet facet_of(double c, double n) {
    const double squared = (n - 1) * (n + 1) + c * c;  // (n cos t)^2
    if (!(squared > 0)) {
        return {};
    }
    const double behind = std::sqrt(squared);
    const double s = (c - behind) / (c + behind);
    const double p = (n * n * c - behind) / (n * n * c + behind);
    return {std::min(1.0, 0.5 * (s * s + p * p)), (c - behind) / n};
}

// G1 of [Heitz2014].
double smith_masking(double c, double alpha) {
    return 2 * c / (c + smith_root(c, alpha));
}

// Density of the normal h as the eye sees them [1/sr].
double pdf_visible(const RoughBoundary& b, const glm::dvec3& h) {
    const double c = b.to_eye.z;
    return 2 * ggx_density(h, b.alpha) * glm::dot(b.to_eye, h) / (c + smith_root(c, b.alpha));
}

// |dh / dl| of h = -(o + n l) / |o + n l|.
double normals_per_direction(double o_h, double l_h, double n) {
    const double sum = o_h + n * l_h;
    return n * n * std::abs(l_h) / (sum * sum);
}

BoundaryValue eval_reflection(const RoughBoundary& b, const glm::dvec3& l) {
    const glm::dvec3& o = b.to_eye;
    const glm::dvec3 h = glm::normalize(o + l);
    const double reflectance = facet_of(glm::dot(o, h), b.ratio).reflectance;
    const double lobe = ggx_density(h, b.alpha) * smith_visibility(o.z, l.z, b.alpha) * l.z;
    const double chance = b.transmits ? reflectance : 1;
    return {static_cast<float>(reflectance * lobe),
            static_cast<float>(chance * pdf_visible_reflection(o.z, h, b.alpha))};
}

BoundaryValue eval_refraction(const RoughBoundary& b, const glm::dvec3& l) {
    const glm::dvec3& o = b.to_eye;
    glm::dvec3 h = o + b.ratio * l;
    h = glm::normalize(h.z < 0 ? -h : h);
    const double o_h = glm::dot(o, h), l_h = glm::dot(l, h);
    if (!(o_h > 0) || !(l_h < 0)) {
        return {};
    }
    const double passing = 1 - facet_of(o_h, b.ratio).reflectance;
    const double pdf = pdf_visible(b, h) * normals_per_direction(o_h, l_h, b.ratio);
    return {static_cast<float>(passing * pdf * smith_masking(-l.z, b.alpha)),
            static_cast<float>((b.reflects ? passing : 1) * pdf)};
}

}  // namespace

RoughBoundary make_rough_boundary(glm::vec3 normal, glm::vec3 to_eye, float alpha, float ratio) {
    RoughBoundary boundary{make_frame(normal), glm::dvec3(0), double{alpha}, double{ratio}};
    boundary.to_eye = into_frame(boundary.frame, to_eye);
    boundary.to_eye.z = std::max(boundary.to_eye.z, kGrazingCosine);
    boundary.to_eye = glm::normalize(boundary.to_eye);
    return boundary;
}

std::optional<BoundarySample> sample_rough_boundary(const RoughBoundary& b, float u, float v,
                                                    float choice) {
    const glm::dvec3& o = b.to_eye;
    const glm::dvec3 h = sample_visible_normal(o, b.alpha, double{u}, double{v});
    const double o_h = glm::dot(o, h);
    if (!(o_h > 0)) return std::nullopt;
    const auto [reflectance, along] = facet_of(o_h, b.ratio);
    double chance = 1, share = 1;
    BoundarySample sample;
    if (b.reflects && b.transmits) {
        sample.transmits = !(double{choice} < reflectance);
        chance = sample.transmits ? 1 - reflectance : reflectance;
    } else {
        sample.transmits = b.transmits;
        share = b.transmits ? 1 - reflectance : reflectance;
    }
    if (!(share > 0)) return std::nullopt;
    glm::dvec3 l;
    double pdf = chance;
    if (sample.transmits) {
        l = glm::normalize(along * h - o / b.ratio);
        if (!(l.z < 0)) return std::nullopt;
        pdf *= pdf_visible(b, h) * normals_per_direction(o_h, glm::dot(l, h), b.ratio);
        share *= smith_masking(-l.z, b.alpha);
    } else {
        l = glm::normalize(2 * o_h * h - o);
        if (!(l.z > 0)) return std::nullopt;
        pdf *= pdf_visible_reflection(o.z, h, b.alpha);
        share *= smith_shadowing(o.z, l.z, b.alpha);
    }
    sample.direction = glm::normalize(b.frame.to_world(glm::vec3(l)));
    sample.weight = static_cast<float>(share);
    sample.pdf = static_cast<float>(pdf);
    return sample;
}

BoundaryValue eval_rough_boundary(const RoughBoundary& b, glm::vec3 to_light) {
    const glm::dvec3 l = into_frame(b.frame, to_light);
    if (l.z > 0) {
        return b.reflects ? eval_reflection(b, l) : BoundaryValue{};
    }
    return b.transmits && l.z < 0 ? eval_refraction(b, l) : BoundaryValue{};
}

BoundarySplit split_at_boundary(glm::vec3 direction, glm::vec3 normal, float ratio) {
    const double n = static_cast<double>(ratio);
    const double c = std::clamp(-static_cast<double>(glm::dot(direction, normal)), 0.0, 1.0);
    BoundarySplit split;
    split.reflected = glm::normalize(direction + 2 * static_cast<float>(c) * normal);
    // Snell: n sin t = sin i; (n cos t)^2 = n^2 - 1 + c^2.
    const double squared = (n - 1) * (n + 1) + c * c;
    if (squared <= 0) {
        split.reflectance = 1;
        return split;
    }
    const double behind = std::sqrt(squared);  // n cos t
    const double s = (c - behind) / (c + behind);
    const double p = (n * n * c - behind) / (n * n * c + behind);
    split.reflectance = static_cast<float>(std::min(1.0, 0.5 * (s * s + p * p)));
    const auto along = static_cast<float>((c - behind) / n);
    split.transmitted = glm::normalize(direction / ratio + along * normal);
    return split;
}

glm::vec3 fitting_normal(glm::vec3 direction, glm::vec3 smooth, glm::vec3 flat) {
    // A ray in the triangle's plane meets the triangles beside it by rounding.
    constexpr float kLeastSine = 1e-3f;
    const auto reflects_in_front = [&](glm::vec3 normal) {
        const float along = glm::dot(direction, normal);
        return along < 0 && glm::dot(direction - 2 * along * normal, flat) > kLeastSine;
    };
    glm::vec3 normal = smooth;
    if (!reflects_in_front(smooth)) {
        normal = flat;
        float wrong = 0, right = 1;  // share of the triangle's normal
        constexpr int kHalvings = 20;
        for (int i = 0; i < kHalvings; ++i) {
            const float middle = 0.5f * (wrong + right);
            const glm::vec3 turned = glm::normalize(glm::mix(smooth, flat, middle));
            const bool fits = reflects_in_front(turned);
            normal = fits ? turned : normal;
            (fits ? right : wrong) = middle;
        }
    }
    return normal;
}

BoundarySplit split_at_smooth_boundary(glm::vec3 direction, glm::vec3 smooth, glm::vec3 flat,
                                       float ratio) {
    BoundarySplit split =
        split_at_boundary(direction, fitting_normal(direction, smooth, flat), ratio);
    if (split.reflectance < 1 && !(glm::dot(split.transmitted, flat) < 0)) {
        split.reflectance = 1;  // beyond the angle of the triangle's own total reflection
    }
    return split;
}

}  // namespace opaline::bake
