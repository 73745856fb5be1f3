#include "bake/lab/path_images/surface_light.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "bake/reference/glossy_brdf.h"

namespace opaline::bake {
namespace {

constexpr float kForever = std::numeric_limits<float>::infinity();

// A lit point, its normal toward the eye.
struct LitPoint {
    glm::vec3 normal{0}, flat{0};
    RayOrigin front, back;
    glm::dvec3 reflect{0}, transmit{0};  // albedo of this side, and of light from the other one
};

LitPoint make_point(const HitScene& surfaces, const SurfaceHit& hit, glm::vec3 direction) {
    const float side = glm::dot(direction, hit.flat) > 0 ? -1.0f : 1.0f;
    LitPoint point{side * hit.smooth, side * hit.flat, leave_surface(hit, side * hit.flat),
                   leave_surface(hit, -side * hit.flat)};
    const OpaqueSurface surface = opaque_surface_at(surfaces.scene(), hit);
    const glm::dvec3 albedo(
        surface.is_diffuse() ? surface.base_color
                             : make_glossy_brdf(surface, point.normal, -direction).diffuse_albedo);
    point.reflect = albedo * glm::dvec3(surface.reflect);
    point.transmit = albedo * glm::dvec3(surface.transmit);
    return point;
}

// Share of each channel of light from a direction that reaches the point.
glm::dvec3 passing(const ScatteringSpace& space, const HitScene& surfaces, const LitPoint& point,
                   glm::vec3 toward) {
    const RayOrigin& from = glm::dot(toward, point.flat) > 0 ? point.front : point.back;
    glm::dvec3 share(0);
    if (surfaces.is_blocked(from, toward)) return share;
    const Columns columns = columns_along(space.volumes, from.position, toward, kForever);
    for (const MediumBand& band : space.bands) {
        double depth = 0;
        for (std::size_t v = 0; v < space.volumes.volumes.size(); ++v) {
            depth += band.extinction[v] * columns[v];
        }
        for (int c = 0; c < 3; ++c) {
            if (band.channel[static_cast<std::size_t>(c)]) {
                share[c] = std::exp(-depth);
            }
        }
    }
    return share;
}

// Radiance per irradiance perpendicular to the light's direction.
glm::dvec3 response(const LitPoint& point, glm::dvec3 toward) {
    const double cosine = glm::dot(glm::dvec3(point.normal), toward);
    const double flat = glm::dot(glm::dvec3(point.flat), toward);
    if (!(cosine * flat > 0)) return glm::dvec3(0);
    return std::abs(cosine) / std::numbers::pi * (cosine > 0 ? point.reflect : point.transmit);
}

}  // namespace

std::optional<SurfaceHit> first_visible_hit(const HitScene& surfaces, glm::vec3 origin,
                                            glm::vec3 direction) {
    const formats::Scene& scene = surfaces.scene();
    RayOrigin from{origin};
    for (std::uint32_t step = 0; step < kMostSteps; ++step) {
        auto hit = surfaces.closest_hit(from, direction, kForever);
        if (!hit) break;
        const formats::Material& material =
            scene.materials[scene.primitives[hit->primitive].material];
        if (!(glm::dot(direction, hit->flat) > 0) || material.double_sided) {
            hit->distance = glm::dot(hit->position - origin, direction);
            return hit;
        }
        from = go_straight_on(from, leave_surface(*hit, direction));
    }
    return std::nullopt;
}

glm::dvec3 reflect_diffusely_once(const ScatteringSpace& space, const HitScene& surfaces,
                                  const SurfaceHit& hit, glm::vec3 direction) {
    const LitPoint point = make_point(surfaces, hit, direction);
    glm::dvec3 sum(0);
    for (const ImageSun& sun : space.lights.suns) {
        const glm::dvec3 each = response(point, sun.direction) * sun.irradiance;
        if (each != glm::dvec3(0)) {
            sum += each * passing(space, surfaces, point, glm::vec3(sun.direction));
        }
    }
    std::array<glm::dvec3, ImageSky::kCellCount> of_cell{};
    for (const SkyTexel& texel : space.lights.sky.texel) {
        of_cell[texel.cell] += response(point, texel.direction) * texel.irradiance;
    }
    for (std::size_t c = 0; c < of_cell.size(); ++c) {
        if (of_cell[c] != glm::dvec3(0)) {
            sum += of_cell[c] * passing(space, surfaces, point, glm::vec3(sky_cells()[c]));
        }
    }
    return sum;
}

}  // namespace opaline::bake
