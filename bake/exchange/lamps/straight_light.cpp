#include "bake/exchange/lamps/straight_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "bake/exchange/lamps/glow_light.h"
#include "bake/exchange/lamps/onward_ray.h"
#include "bake/exchange/lamps/spread_points.h"
#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/scene/punctual_light.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

// A shadow ray ends before the surface that it goes to.
constexpr float kShadowEnd = 1 - 1e-4f;

/// Rays from one receiver, sixteen at a time.
class ShadowRays {
  public:
    ShadowRays(const RayScene& scene, const Receiver& receiver, std::uint64_t& rays,
               const DensitySpace* volumes, const glm::dvec3& extinction)
        : scene_(scene),
          volumes_(volumes),
          extinction_(extinction),
          origin_(receiver.origin),
          packet_(rays_from(receiver.origin)),
          rays_(rays) {}

    /// Adds `light` to the irradiance if nothing blocks the unit direction up to `reach`.
    void add(const glm::vec3& direction, float reach, const glm::dvec3& light) {
        set_lane(packet_, lanes_, count_, direction, reach);
        light_[count_] = light;
        reach_[count_] = static_cast<double>(reach);
        if (++count_ == RayPacket::kSize) trace();
    }

    glm::dvec3 arrived() {
        if (count_ > 0) trace();
        return arrived_;
    }

  private:
    void trace() {
        rays_ += count_;
        if (!scene_.is_empty()) scene_.occluded(lanes_, packet_);
        for (std::size_t i = 0; i < count_; ++i) {
            if (!(packet_.tfar[i] >= 0)) continue;
            const glm::dvec3 direction(direction_of(packet_, i));
            // From far away nothing is inside of a medium.
            const glm::dvec3 left =
                extinction_ == glm::dvec3(0) ? glm::dvec3(1) : glm::exp(-reach_[i] * extinction_);
            arrived_ +=
                left * light_[i] * volume_transmittance(volumes_, origin_, direction, reach_[i]);
        }
        lanes_ = {};
        count_ = 0;
    }

    const RayScene& scene_;
    const DensitySpace* volumes_;
    glm::dvec3 extinction_;
    glm::dvec3 origin_;
    RayPacket packet_;
    LaneMask lanes_{};
    std::array<glm::dvec3, RayPacket::kSize> light_{};
    std::array<double, RayPacket::kSize> reach_{};
    std::size_t count_ = 0;
    glm::dvec3 arrived_{0};
    std::uint64_t& rays_;
};

// cos cos' / d^2 between a point and one of a triangle.
double geometry(const glm::dvec3& way, const glm::dvec3& normal, const glm::dvec3& other) {
    const double square = glm::dot(way, way);
    return square > 0 ? std::max(0.0, glm::dot(normal, way)) * std::abs(glm::dot(other, way)) /
                            (square * square)
                      : 0.0;
}

// The triangles that a lamp is to a point: textured ones in parts that are even or far from it.
std::vector<const GlowingTriangle*> triangles_from(const LampSources& lamp,
                                                   const glm::dvec3& point) {
    constexpr double kFar = 4;  // radii
    std::vector<const GlowingTriangle*> triangles;
    if (lamp.parts.empty()) {
        triangles.reserve(lamp.triangles.size());
        for (const GlowingTriangle& triangle : lamp.triangles) {
            triangles.push_back(&triangle);
        }
        return triangles;
    }
    for (std::size_t i = 0; i < lamp.parts.size();) {
        const GlowingPart& part = lamp.parts[i];
        const auto& corner = part.whole.corner;
        const glm::dvec3 centre = (corner[0] + corner[1] + corner[2]) / 3.0;
        double radius = 0;  // squared
        for (const glm::dvec3& at : corner) {
            radius = std::max(radius, glm::dot(at - centre, at - centre));
        }
        const glm::dvec3 way = point - centre;
        const bool is_taken = part.is_even || glm::dot(way, way) > kFar * kFar * radius;
        if (is_taken) triangles.push_back(&part.whole);
        i = is_taken ? part.next : i + 1;
    }
    return triangles;
}

glm::dvec3 from_triangles(const LampSources& lamp, const Receiver& receiver, std::uint32_t samples,
                          std::uint32_t first, ShadowRays shadow) {
    const glm::dvec3 point(receiver.origin), normal(receiver.normal);
    const std::vector<const GlowingTriangle*> triangles = triangles_from(lamp, point);
    std::vector<double> factor(triangles.size()), cumulative(triangles.size());
    glm::dvec3 total(0);
    double sum = 0;
    for (std::size_t t = 0; t < factor.size(); ++t) {
        const GlowingTriangle& triangle = *triangles[t];
        factor[t] = triangle_irradiance(triangle, point, normal);
        total += factor[t] * triangle.radiance;
        sum += factor[t] * largest_band(triangle.radiance);
        cumulative[t] = sum;
    }
    if (!(sum > 0)) return glm::dvec3(0);
    glm::dvec3 all(0);
    double whole = 0;
    const double offset = std::modf(0.5 + first / std::numbers::phi, &whole);
    for (std::uint32_t i = 0; i < samples; ++i) {
        const double at = (i + offset) / samples * sum;
        const std::size_t t = part_of_sum(cumulative, at);
        const GlowingTriangle& triangle = *triangles[t];
        const glm::dvec2 uv = spread_point(glm::dvec2(0.5), first + i + 1);
        const glm::dvec3 way = sample_triangle_folded(triangle.corner, uv.x, uv.y).P - point;
        const double distance = glm::length(way);
        // Its mean over the triangle is radiance / largest: the choice is in proportion to both.
        const double weight = geometry(way, normal, triangle.normal) * triangle.area / factor[t];
        if (!(distance > 0) || !std::isfinite(weight) || !(weight > 0)) continue;
        const glm::dvec3 light = weight / largest_band(triangle.radiance) * triangle.radiance;
        all += light;
        shadow.add(glm::vec3(way / distance), static_cast<float>(distance) * kShadowEnd, light);
    }
    const glm::dvec3 arrived = shadow.arrived();
    glm::dvec3 irradiance(0);
    for (int band = 0; band < 3; ++band) {
        if (all[band] > 0) irradiance[band] = total[band] * (arrived[band] / all[band]);
    }
    return irradiance;
}

glm::dvec3 from_lights(const LampSources& lamp, const Receiver& receiver, ShadowRays shadow) {
    for (const formats::Light& light : lamp.lights) {
        const ArrivingLight arriving = light_at(light, receiver.origin);
        const float cosine = glm::dot(arriving.to_light, receiver.normal);
        if (!(cosine > 0) || arriving.irradiance == formats::Rgb{}) continue;
        const formats::Rgb e = cosine * arriving.irradiance;
        // Lights have no surface: the ray goes all the way.
        shadow.add(arriving.to_light, arriving.distance, glm::dvec3(e.r, e.g, e.b));
    }
    return shadow.arrived();
}

}  // namespace

double triangle_irradiance(const GlowingTriangle& triangle, const glm::dvec3& point,
                           const glm::dvec3& normal) {
    const double side = glm::dot(triangle.normal, point - triangle.corner[0]);
    if (side == 0 || (side < 0 && !triangle.is_two_sided)) return 0;
    // At most four corners, once the part below the horizon is cut off.
    std::array<glm::dvec3, 4> way;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 a = triangle.corner[k] - point, b = triangle.corner[(k + 1) % 3] - point;
        const double above = glm::dot(normal, a), next = glm::dot(normal, b);
        if (above >= 0) way[count++] = a;
        if ((above > 0 && next < 0) || (above < 0 && next > 0)) {
            way[count++] = a + above / (above - next) * (b - a);
        }
    }
    if (count < 3) return 0;
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec3 &a = way[k], &b = way[(k + 1) % count];
        const glm::dvec3 cross = glm::cross(a, b);
        const double sine = glm::length(cross);
        if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(normal, cross) / sine;
    }
    return 0.5 * std::abs(sum);
}

glm::dvec3 straight_irradiance(const RayScene& scene, const LampSources& lamp,
                               const Receiver& receiver, std::uint32_t samples, std::uint64_t& rays,
                               const DensitySpace* volumes, std::uint32_t first) {
    if (receiver.normal == glm::vec3(0)) return glm::dvec3(0);
    const ShadowRays shadow(scene, receiver, rays, volumes, lamp.extinction);
    return from_triangles(lamp, receiver, samples, first, shadow) +
           from_lights(lamp, receiver, shadow);
}

}  // namespace opaline::bake
