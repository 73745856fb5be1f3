#include "bake/exchange/narrow_lobe.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/physics/path_differentials/lobe.h"
#include "bake/plan/surface_albedo.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {
namespace {

// What a coat mirrors of light along its normal where its cells need one ray.
constexpr float kWeakLobe = 0.2f;

float largest_of(const formats::Rgb& c) {
    return std::max({c.r, c.g, c.b});
}

// Of the vertices, on the facet's side; the facet's where the ray is behind it.
glm::vec3 interpolated_normal(const formats::Scene& scene, const RayEnd& end) {
    const formats::Primitive& p = scene.primitives[end.triangle.primitive];
    if (p.normal.empty()) return end.side.normal;
    const float u = end.triangle.u, v = end.triangle.v;
    const std::uint32_t* const corner = &p.index[end.triangle.first_index];
    const glm::vec3 sum =
        (1 - u - v) * p.normal[corner[0]] + u * p.normal[corner[1]] + v * p.normal[corner[2]];
    const float length = glm::length(sum);
    if (!(length > 0)) return end.side.normal;
    const glm::vec3 normal = std::copysign(1 / length, glm::dot(sum, end.side.normal)) * sum;
    constexpr float kGrazing = 1e-3f;
    return -glm::dot(normal, end.direction) > kGrazing ? normal : end.side.normal;
}

// G2 / G1(o) of Smith's masking, correlated in height [Heitz2014].
double shadowing_of(double c_o, double c_l, double alpha) {
    const auto root = [&](double c) {
        return std::sqrt(alpha * alpha + (1 - alpha * alpha) * c * c);
    };
    return c_l * (c_o + root(c_o)) / (c_o * root(c_l) + c_l * root(c_o));
}

}  // namespace

glm::dvec3 sample_narrow_lobe(const formats::GlossSurface& lobe, const glm::dvec3& to_eye,
                              const glm::dvec3& flat, const std::array<float, 4>& u) {
    constexpr std::size_t kCandidates = 4;
    const double alpha{formats::ggx_alpha(lobe.roughness)};
    const double f0{largest_of(lobe.f0)}, f90{lobe.f90};
    std::array<glm::dvec3, kCandidates> way{};
    std::array<double, kCandidates> cumulative{};
    double sum = 0;
    for (std::size_t i = 0; i < kCandidates; ++i) {
        // One in each quarter of the square.
        const double x = 0.5 * static_cast<double>(i % 2), y = i < 2 ? 0.0 : 0.5;
        const glm::dvec3 m =
            sample_visible_normal(to_eye, {alpha, alpha}, 0.5 * static_cast<double>(u[0]) + x,
                                  0.5 * static_cast<double>(u[1]) + y)
                .m;
        const double cosine = glm::dot(to_eye, m);
        way[i] = 2 * cosine * m - to_eye;
        if (cosine > 0 && way[i].z > 0 && glm::dot(way[i], flat) > 0) {
            sum += shadowing_of(to_eye.z, way[i].z, alpha) *
                   (f0 + (f90 - f0) * double{formats::schlick_weight(static_cast<float>(cosine))});
        }
        cumulative[i] = sum;
    }
    if (sum > 0) {
        const auto chosen = std::ranges::upper_bound(cumulative, static_cast<double>(u[2]) * sum);
        const auto last = static_cast<std::ptrdiff_t>(kCandidates - 1);
        return way[static_cast<std::size_t>(std::min(chosen - cumulative.begin(), last))];
    }
    const glm::dvec3 mirror(-to_eye.x, -to_eye.y, to_eye.z);
    return glm::dot(mirror, flat) > 0 ? mirror : glm::dvec3(0);
}

MirroredRay mirror_by_lobe(const BounceSpace& space, const RayEnd& end, const formats::Rgb& share,
                           std::uint32_t number) {
    constexpr float kGrazing = 1e-3f;
    if (space.layouts.empty()) return {};
    const TrianglePlace& at = end.triangle;
    const std::optional<formats::GlossSurface> lobe = eval_narrow_lobe(
        space.scene, space.layouts[end.material],
        surface_place(space.scene, at.primitive, at.first_index, {1 - at.u - at.v, at.u, at.v}));
    if (!lobe) return {};
    const auto u =
        random_uniform(0, RandomStage::bounce_rays, key_of({end.position, end.direction}));
    glm::vec3 normal = interpolated_normal(space.scene, end);
    glm::dvec3 direction(0);
    float cosine = 0;
    Frame frame;
    // Interpolated normals may mirror all into the facet.
    for (int attempt = 0; attempt < 2 && direction == glm::dvec3(0); ++attempt) {
        if (attempt == 1) {
            normal = end.side.normal;
        }
        frame = make_frame(normal);
        const auto in_frame = [&](const glm::vec3& d) {
            return glm::dvec3(glm::dot(frame.u, d), glm::dot(frame.v, d), glm::dot(normal, d));
        };
        glm::dvec3 to_eye = in_frame(-end.direction);
        to_eye.z = std::max(to_eye.z, static_cast<double>(kGrazing));
        to_eye = glm::normalize(to_eye);
        cosine = static_cast<float>(to_eye.z);
        direction = sample_narrow_lobe(*lobe, to_eye, in_frame(end.side.normal), u);
    }
    if (direction == glm::dvec3(0)) return {};
    const formats::Rgb albedo = formats::eval_gloss_albedo(*lobe, cosine).specular;
    const formats::Rgb mirrored{std::min(albedo.r, 1.0f), std::min(albedo.g, 1.0f),
                                std::min(albedo.b, 1.0f)};
    return {.origin = end.position + end.error * end.side.normal,
            .direction = glm::normalize(frame.to_world(glm::vec3(direction))),
            .share = mirrored * share,
            .number = number,
            .of_lobe = largest_of(mirrored),
            .is_weak = largest_of(lobe->f0) < kWeakLobe};
}

}  // namespace opaline::bake
