#include "bake/reference/lamp_sampler.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/scene/base_color.h"

namespace opaline::bake {
namespace {

using formats::Material;
using formats::Primitive;

float sum_of(formats::Rgb c) {
    return c.r + c.g + c.b;
}

glm::vec3 vec_of(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

std::array<std::uint32_t, 3> corners_of(const Primitive& p, std::uint32_t triangle) {
    const std::uint32_t* corner = &p.index[3 * std::size_t{triangle}];
    return {corner[0], corner[1], corner[2]};
}

bool is_two_sided(const Material& material) {
    return material.double_sided && !material.medium;
}

// Weights of the corners, uniform over a triangle's area.
std::array<float, 3> place_in_triangle(float u, float v) {
    const float root = std::sqrt(u);
    return {1 - root, root * (1 - v), root * v};
}

// Mean brightness over a triangle; never 0 by a texture, so that what its samples miss is drawn.
float mean_brightness(const formats::Scene& scene, std::uint32_t primitive,
                      std::uint32_t triangle) {
    const Primitive& p = scene.primitives[primitive];
    const Material& material = scene.materials[p.material];
    const float whole = sum_of(material.emission);
    if (material.emission_image == formats::kNone || p.texcoord.empty()) return whole;
    constexpr int steps = 4;
    float mean = 0;
    for (int i = 0; i < steps * steps; ++i) {
        const float u = (static_cast<float>(i % steps) + 0.5f) / steps;
        const float v = (static_cast<float>(i) + 0.5f) / (steps * steps);
        mean +=
            sum_of(emission_at(scene, primitive, corners_of(p, triangle), place_in_triangle(u, v)));
    }
    mean /= steps * steps;
    constexpr float kLeastShare = 1.0f / 16;
    return std::max(mean, kLeastShare * whole);
}

}  // namespace

LampSampler make_lamp_sampler(const formats::Scene& scene) {
    LampSampler lamps;
    for (const formats::Light& light : scene.lights) {
        if (sum_of(light.intensity) > 0) {
            lamps.lights.push_back(light);
        }
    }
    lamps.density.resize(scene.primitives.size());
    double power = 0;
    for (std::uint32_t i = 0; i < scene.primitives.size(); ++i) {
        const Primitive& p = scene.primitives[i];
        const Material& material = scene.materials[p.material];
        if (!is_emissive(material)) continue;
        lamps.density[i].assign(p.index.size() / 3, 0.0f);
        for (std::uint32_t t = 0; t < p.index.size() / 3; ++t) {
            const auto corner = corners_of(p, t);
            const glm::dvec3 a(p.position[corner[0]]), b(p.position[corner[1]]),
                c(p.position[corner[2]]);
            const glm::dvec3 cross = glm::cross(b - a, c - a);
            const double length = glm::length(cross);
            const auto brightness = static_cast<double>(mean_brightness(scene, i, t));
            if (!(length > 0) || !std::isfinite(length)) continue;
            power += 0.5 * length * brightness * (is_two_sided(material) ? 2 : 1);
            lamps.cumulative.push_back(power);
            // For now in units of the power; divided by the sum below.
            const auto density = static_cast<float>(brightness * (is_two_sided(material) ? 2 : 1));
            lamps.triangles.push_back(
                {i, t, glm::vec3(cross / length), density, is_two_sided(material)});
        }
    }
    if (!(power > 0)) {
        lamps.triangles.clear();
        lamps.cumulative.clear();
        return lamps;
    }
    for (std::size_t i = 0; i < lamps.triangles.size(); ++i) {
        LampSampler::Triangle& one = lamps.triangles[i];
        lamps.cumulative[i] /= power;
        one.density = static_cast<float>(static_cast<double>(one.density) / power);
        lamps.density[one.primitive][one.triangle] = one.density;
    }
    lamps.cumulative.back() = 1;
    return lamps;
}

bool is_seen_to_glow(const Material& material, glm::vec3 direction, glm::vec3 flat) {
    return is_emissive(material) && (is_two_sided(material) || glm::dot(direction, flat) < 0);
}

glm::vec3 emission_of_vertex(const formats::Scene& scene, std::uint32_t primitive,
                             std::uint32_t vertex) {
    return vec_of(emission_at(scene, primitive, {vertex, vertex, vertex}, {1, 0, 0}));
}

std::optional<SeenTriangle> sample_triangle(const LampSampler& lamps, const formats::Scene& scene,
                                            glm::vec3 from, RandomStream& random) {
    const double choice = static_cast<double>(random.next());
    const glm::vec2 place = random.next_pair();
    const auto above =
        std::upper_bound(lamps.cumulative.begin(), lamps.cumulative.end() - 1, choice);
    const LampSampler::Triangle& one =
        lamps.triangles[static_cast<std::size_t>(above - lamps.cumulative.begin())];
    const Primitive& p = scene.primitives[one.primitive];
    const auto corner = corners_of(p, one.triangle);
    const auto weight = place_in_triangle(place.x, place.y);
    const glm::vec3 way = weight[0] * p.position[corner[0]] + weight[1] * p.position[corner[1]] +
                          weight[2] * p.position[corner[2]] - from;
    const float square = glm::dot(way, way);
    if (!(square > 0)) return std::nullopt;
    SeenTriangle seen{one.primitive, one.triangle, way / std::sqrt(square), glm::vec3(0), 0};
    float cosine = -glm::dot(seen.direction, one.normal);
    if (one.is_two_sided) {
        cosine = std::abs(cosine);
    }
    if (!(cosine > 0)) return std::nullopt;
    seen.pdf = one.density * square / cosine;
    seen.radiance = vec_of(emission_at(scene, one.primitive, corner, weight));
    return seen;
}

float pdf_triangle(const LampSampler& lamps, const SurfaceHit& hit, glm::vec3 from) {
    const std::vector<float>& density = lamps.density[hit.primitive];
    if (density.empty()) return 0;
    const glm::vec3 way = hit.position - from;
    const float square = glm::dot(way, way);
    const float cosine = std::abs(glm::dot(way, hit.flat)) / std::sqrt(square);
    return square > 0 && cosine > 0 ? density[hit.triangle] * square / cosine : 0;
}

std::optional<ArrivingLight> sample_punctual(const LampSampler& lamps, glm::vec3 at,
                                             RandomStream& random) {
    double sum = 0;
    for (const formats::Light& light : lamps.lights) {
        sum += static_cast<double>(sum_of(light_at(light, at).irradiance));
    }
    if (!(sum > 0)) return std::nullopt;
    double choice = lamps.lights.size() > 1 ? static_cast<double>(random.next()) * sum : 0;
    ArrivingLight last;
    double share = 1;
    for (const formats::Light& light : lamps.lights) {
        const ArrivingLight arriving = light_at(light, at);
        const auto own = static_cast<double>(sum_of(arriving.irradiance));
        if (!(own > 0)) continue;
        last = arriving;
        share = own / sum;
        if (choice < own) break;
        choice -= own;
    }
    last.irradiance = static_cast<float>(1 / share) * last.irradiance;
    return last;
}

}  // namespace opaline::bake
