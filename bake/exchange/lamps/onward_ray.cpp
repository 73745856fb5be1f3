#include "bake/exchange/lamps/onward_ray.h"

#include <algorithm>
#include <cmath>

#include "bake/physics/fresnel.h"
#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/physics/path_differentials/lobe.h"
#include "bake/physics/path_differentials/surface_shape.h"
#include "bake/scene/base_color.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

constexpr double kSmoothest = 1e-3;  // alpha: a mirror, for every purpose
constexpr double kGrazing = 1e-3;

// The interpolated normal, facing the ray. The triangle's own where it does not.
SurfaceShape shape_at(const formats::Scene& scene, const Arrival& at, const glm::dvec3& direction) {
    const formats::Primitive& primitive = scene.primitives[at.side.primitive];
    const SurfaceShape flat{at.normal, glm::dmat3(0.0)};
    if (primitive.normal.empty()) return flat;
    std::array<glm::dvec3, 3> corners;
    std::array<glm::dvec3, 3> normals;
    glm::dvec3 sum(0);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = primitive.index[at.side.first_index + k];
        corners[k] = glm::dvec3(primitive.position[vertex]);
        normals[k] = glm::dvec3(primitive.normal[vertex]);
        sum += at.weights[static_cast<int>(k)] * normals[k];
    }
    if (!(glm::length(sum) > 0)) return flat;
    const glm::dvec3 P =
        at.weights.x * corners[0] + at.weights.y * corners[1] + at.weights.z * corners[2];
    const SurfaceShape shape = interpolated_shape(corners, normals, P);
    const SurfaceShape facing = glm::dot(shape.N, at.normal) < 0 ? flipped(shape) : shape;
    return -glm::dot(facing.N, direction) > kGrazing ? facing : flat;
}

glm::dvec3 schlick(const glm::dvec3& f0, double cosine) {
    return f0 + (1.0 - f0) * std::pow(std::clamp(1 - cosine, 0.0, 1.0), 5);
}

// G2 / G1(o) of Smith's masking, correlated in height [Heitz2014].
double shadowing(double c_o, double c_l, double alpha) {
    const auto root = [&](double c) {
        return std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c);
    };
    return c_l * (c_o + root(c_o)) / (c_o * root(c_l) + c_l * root(c_o));
}

/// A ray at the boundary of a medium.
struct Crossing {
    double beyond = 1;  ///< index of the other side over this one's
    double alpha = 0;   ///< GGX roughness of the boundary
    double choice = 0;  ///< random number
    std::array<double, 2> x{};
};

/// A facet of a rough surface as a ray meets it.
struct Facet {
    double alpha = 0, eta = 0;  ///< FacetEvent's: 0 reflects
    std::array<double, 2> x{};
};

// The direction by way of a facet. The new columns have the relative change of the density of
// normals, D(m) = c / ((a^2 - 1) m_z^2 + 1)^2; older ones turn the lobe with them.
std::optional<glm::dvec3> scatter_by_facet(const Facet& facet, const SurfaceShape& shape,
                                           const Arrival& at, const glm::dvec3& D,
                                           const DifferentialRules& rules, PathDifferential& path) {
    const auto out = scatter_on_facets(path, rules,
                                       {.D = D,
                                        .N = shape.N,
                                        .dN_dP = shape.dN_dP,
                                        .alpha = facet.alpha,
                                        .eta = facet.eta,
                                        .u = facet.x[0],
                                        .v = facet.x[1],
                                        .N_g = at.normal});
    if (!out) return out;
    const VisibleNormal normal =
        sample_visible_normal(glm::transpose(frame_around(shape.N)) * -D,
                              {facet.alpha, facet.alpha}, facet.x[0], facet.x[1]);
    const double a = facet.alpha * facet.alpha - 1, z = normal.m.z;
    const auto change = [&](const glm::dvec3& dm) { return -4 * a * z * dm.z / (a * z * z + 1); };
    path.column[path.count - 2].dlnW += change(normal.dm_du);
    path.column[path.count - 1].dlnW += change(normal.dm_dv);
    return out;
}

// Refraction or, from inside, reflection by a facet of rough glass.
std::optional<OnwardRay> cross_rough_boundary(const Crossing& crossing, const SurfaceShape& shape,
                                              const Arrival& at, const glm::dvec3& D,
                                              const DifferentialRules& rules,
                                              PathDifferential& path) {
    const double cosine = std::min(1.0, -glm::dot(D, shape.N));
    // A facet may do what the surface does not.
    const double mirrored =
        at.side.is_back ? std::clamp(fresnel_reflectance(cosine, crossing.beyond), 0.1, 0.9) : 0;
    const bool refracts = !(crossing.choice < mirrored);
    const auto out =
        scatter_by_facet({crossing.alpha, refracts ? 1 / crossing.beyond : 0, crossing.x}, shape,
                         at, D, rules, path);
    if (!out) return std::nullopt;
    const glm::dvec3 facet = refracts ? glm::normalize(crossing.beyond * *out - D)  // either sign
                                      : glm::normalize(*out - D);
    const double reflectance =
        fresnel_reflectance(std::min(1.0, std::abs(glm::dot(D, facet))), crossing.beyond);
    OnwardRay onward{.direction = *out, .crosses = refracts};
    onward.weight =
        glm::dvec3(shadowing(cosine, std::abs(glm::dot(*out, shape.N)), crossing.alpha) *
                   (refracts ? (1 - reflectance) / (1 - mirrored) : reflectance / mirrored));
    if ((glm::dot(*out, at.normal) < 0) != refracts) return std::nullopt;
    return onward;
}

glm::vec3 color_of(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

glm::vec3 clamped_color(const formats::Scene& scene, const SurfacePlace& place,
                        const TextureView* view) {
    return glm::clamp(base_color(scene, place, view), glm::vec3(0), glm::vec3(1));
}

}  // namespace

double mirror_chance(const formats::Scene& scene, const Arrival& at, const glm::dvec3& direction) {
    const MetalPart metal = metal_part(scene, at.side, glm::vec3(at.weights));
    return metal.metallic == 0
               ? 0.0
               : metal.metallic *
                     largest_band(schlick(metal.color, -glm::dot(at.normal, direction)));
}

std::optional<OnwardRay> mirror_ray(const formats::Scene& scene, const Arrival& at,
                                    const glm::dvec3& direction, std::array<double, 2> x,
                                    const DifferentialRules& rules, PathDifferential& path) {
    const MetalPart metal = metal_part(scene, at.side, glm::vec3(at.weights));
    if (!(metal.metallic > 0)) return std::nullopt;
    const SurfaceShape shape = shape_at(scene, at, direction);
    OnwardRay onward;
    if (metal.alpha <= kSmoothest) {
        const Mirror mirror = make_mirror(direction, shape.N);
        reflect_columns(path, mirror, shape.dN_dP);
        onward.direction = mirror.reflected;
        onward.weight = metal.metallic * schlick(metal.color, -mirror.k);
    } else {
        const auto out = scatter_by_facet({metal.alpha, 0, x}, shape, at, direction, rules, path);
        if (!out) return std::nullopt;
        const glm::dvec3 facet = glm::normalize(*out - direction);
        onward.direction = *out;
        onward.weight =
            metal.metallic *
            shadowing(-glm::dot(direction, shape.N), glm::dot(*out, shape.N), metal.alpha) *
            schlick(metal.color, glm::dot(*out, facet));
    }
    if (!(glm::dot(onward.direction, at.normal) > 0)) return std::nullopt;
    return onward;
}

bool lets_through(const formats::Scene& scene, const Arrival& at) {
    const auto& medium = scene.materials[at.material].medium;
    return medium && !medium->variation && !(medium->thickness > 0);
}

std::optional<OnwardRay> cross_boundary(const formats::Scene& scene, const Arrival& at,
                                        const glm::dvec3& direction, std::array<double, 3> x,
                                        const DifferentialRules& rules, PathDifferential& path) {
    const SurfaceShape shape = shape_at(scene, at, direction);
    const formats::Medium& medium = *scene.materials[at.material].medium;
    const double eta{medium.eta}, roughness{medium.roughness};
    const double beyond = at.side.is_back ? 1 / eta : eta;
    const bool is_clear = medium.sigma_s == formats::Rgb{};
    if (is_clear && eta != 1 && roughness * roughness > kSmoothest) {
        return cross_rough_boundary({beyond, roughness * roughness, x[2], {x[0], x[1]}}, shape, at,
                                    direction, rules, path);
    }
    const double cosine = std::min(1.0, -glm::dot(direction, shape.N));
    const double reflectance = fresnel_reflectance(cosine, beyond);
    const auto refraction = make_refraction(direction, shape.N, 1 / beyond);
    OnwardRay onward{.weight = glm::dvec3(1)};
    if (refraction && !(at.side.is_back && x[2] < reflectance)) {
        refract_columns(path, rules, *refraction, shape.dN_dP);
        onward.direction = refraction->refracted;
        onward.crosses = true;
        if (!at.side.is_back) onward.weight *= 1 - reflectance;
        if (!(glm::dot(onward.direction, at.normal) < 0)) return std::nullopt;
        return onward;
    }
    if (!at.side.is_back) return std::nullopt;
    const Mirror mirror = make_mirror(direction, shape.N);
    reflect_columns(path, mirror, shape.dN_dP);
    onward.direction = mirror.reflected;
    if (!(glm::dot(onward.direction, at.normal) > 0)) return std::nullopt;
    return onward;
}

glm::dvec3 straight_transmittance(const formats::Scene& scene, const Arrival& at) {
    const auto& medium = scene.materials[at.material].medium;
    if (!medium || !at.side.is_back) return glm::dvec3(1);
    const auto band = [&](float s, float a) {
        return std::exp(-(double{s} + double{a}) * at.distance);
    };
    return {band(medium->sigma_s.r, medium->sigma_a.r), band(medium->sigma_s.g, medium->sigma_a.g),
            band(medium->sigma_s.b, medium->sigma_a.b)};
}

std::optional<Arrival> arrival_of(const PacketHits& hits, std::size_t lane) {
    if (hits.hit[lane] == 0 || hits.cosine[lane] == 0) return std::nullopt;
    const bool is_back = hits.cosine[lane] > 0;
    const glm::dvec3 normal(hits.normal_x[lane], hits.normal_y[lane], hits.normal_z[lane]);
    Arrival arrival;
    arrival.side = {hits.primitive[lane], hits.first_index[lane], is_back};
    const double u = hits.u[lane], v = hits.v[lane];
    arrival.weights = {1 - u - v, u, v};
    arrival.normal = is_back ? -normal : normal;
    arrival.material = hits.material[lane];
    arrival.distance = hits.distance[lane];
    arrival.error = hits.error[lane];
    return arrival;
}

std::optional<Arrival> find_arrival(const RayScene& surfaces, const glm::vec3& from,
                                    const glm::vec3& direction) {
    return arrival_of(closest_of_one(surfaces, from, direction), 0);
}

glm::dvec3 leave_surface(const glm::dvec3& from, const glm::dvec3& direction, const Arrival& at,
                         bool crosses) {
    const glm::dvec3 hit = from + at.distance * direction;
    if (crosses) return hit - 2 * at.error * at.normal;
    const double back = std::min(2 * at.error / -glm::dot(direction, at.normal), 0.5 * at.distance);
    return hit - back * direction;
}

BounceColor bounce_color(const formats::Scene& scene, const TriangleSide& side,
                         const glm::vec3& weights, const TextureView* view) {
    const formats::Primitive& primitive = scene.primitives[side.primitive];
    const formats::Material& material = scene.materials[primitive.material];
    if (material.medium || (side.is_back && !material.double_sided && !material.sheet)) return {};
    const SurfacePlace place = surface_place(scene, side.primitive, side.first_index, weights);
    const float metallic = material.gloss.metallic * roughness_texture(scene, place, view).b;
    const glm::dvec3 color((1 - metallic) * clamped_color(scene, place, view));
    if (!material.sheet) return {color, glm::dvec3(0)};
    return {color * glm::dvec3(color_of(material.sheet->reflect)),
            color * glm::dvec3(color_of(material.sheet->transmit))};
}

MetalPart metal_part(const formats::Scene& scene, const TriangleSide& side,
                     const glm::vec3& weights) {
    const formats::Primitive& primitive = scene.primitives[side.primitive];
    const formats::Material& material = scene.materials[primitive.material];
    const formats::Gloss& gloss = material.gloss;
    if (material.medium || material.sheet || gloss.metallic == 0 ||
        (side.is_back && !material.double_sided)) {
        return {};
    }
    const SurfacePlace place = surface_place(scene, side.primitive, side.first_index, weights);
    const glm::vec3 texture = roughness_texture(scene, place);
    const double roughness{gloss.roughness * texture.g};
    return {glm::dvec3(clamped_color(scene, place, nullptr)), double{gloss.metallic * texture.b},
            roughness * roughness};
}

}  // namespace opaline::bake
