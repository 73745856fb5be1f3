#include "bake/effects/volumes/largest_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opaline::bake {
namespace {

std::array<double, 3> bands(formats::Rgb c) {
    return {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b)};
}

// Of a box, by its corners.
double longest_line(const std::array<glm::dvec3, 8>& corners) {
    return std::max({glm::length(corners[7] - corners[0]), glm::length(corners[6] - corners[1]),
                     glm::length(corners[5] - corners[2]), glm::length(corners[3] - corners[4])});
}

}  // namespace

VolumeBrightness brightest(const formats::Volume& volume) {
    const std::array<double, 3> depth = largest_depth(volume), albedo = bands(volume.albedo);
    VolumeBrightness most;
    for (std::size_t band = 0; band < 3; ++band) {
        const double share = -std::expm1(-depth[band]);
        most.seen = std::max(most.seen, share);
        most.albedo = std::max(most.albedo, albedo[band]);
        most.once = std::max(most.once, albedo[band] * share);
    }
    return most;
}

std::array<double, 3> largest_depth(const formats::Volume& volume) {
    // The longest line through the bricks, as dense as the densest voxel of all.
    const double diagonal = longest_line(volume.density.corners());
    const double densest =
        volume.density.empty()
            ? 0
            : static_cast<double>(*std::ranges::max_element(volume.density.value));
    std::array<double, 3> depth = bands(volume.sigma_t);
    for (double& d : depth) {
        d *= densest * diagonal;
    }
    return depth;
}

double largest_sent_light(const formats::Scene& scene, const formats::Volume& volume) {
    const std::array<glm::dvec3, 8> corners = volume.density.corners();
    const glm::dvec3 middle = 0.5 * (corners[0] + corners[7]);
    const double radius = 0.5 * longest_line(corners);
    double nearest = std::numeric_limits<double>::infinity();
    for (const formats::Primitive& primitive : scene.primitives) {
        glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
        for (const glm::vec3& p : primitive.position) {
            low = glm::min(low, glm::dvec3(p));
            high = glm::max(high, glm::dvec3(p));
        }
        if (!primitive.position.empty()) {
            nearest = std::min(nearest, glm::length(middle - glm::clamp(middle, low, high)));
        }
    }
    const double share = radius < nearest ? radius / nearest : 1;
    return brightest(volume).once * (std::isinf(nearest) ? 0 : share * share);
}

SentShare largest_share_of_surfaces(const formats::Scene& scene) {
    SentShare most{.is_grey = true};
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        float vertex = 0;
        bool is_there = false;
        for (const formats::Primitive& primitive : scene.primitives) {
            if (primitive.material != m || primitive.index.empty()) continue;
            is_there = true;
            vertex = primitive.color.empty() ? std::max(vertex, 1.0f) : vertex;
            for (const formats::Rgb& c : primitive.color) {
                vertex = std::max({vertex, c.r, c.g, c.b});
            }
        }
        if (is_there) {
            const SentShare own = find_sent_share(scene, m, vertex);
            most.diffuse = std::max(most.diffuse, own.diffuse);
            most.all = std::max(most.all, own.all);
            most.is_grey = most.is_grey && own.is_grey;
        }
    }
    return most;
}

double largest_glow(const formats::Volume& volume) {
    float most = 0;
    for (const glm::vec3& v : volume.emission.value) {
        most = std::max({most, v.x, v.y, v.z});
    }
    if (!(most > 0)) return 0;
    formats::SparseGrid<glm::vec3> box = volume.emission;
    box.to_scene = volume.density.to_scene;
    return static_cast<double>(most) * longest_line(box.corners());
}

double largest_scattered_glow(const formats::Scene& scene, const formats::Volume& volume) {
    // A flight meets the next collision in some volume: at most all depths together.
    std::array<double, 3> depth{}, albedo{};
    for (const formats::Volume& each : scene.volumes) {
        const std::array<double, 3> own = largest_depth(each), scatters = bands(each.albedo);
        for (std::size_t band = 0; band < 3; ++band) {
            depth[band] += own[band];
            albedo[band] = std::max(albedo[band], own[band] > 0 ? scatters[band] : 0);
        }
    }
    double most = 0;
    for (std::size_t band = 0; band < 3; ++band) {
        most = std::max(most, albedo[band] * -std::expm1(-depth[band]));
    }
    const double glow = largest_glow(volume);
    return most < 1 ? glow / (1 - most) : (glow > 0 ? std::numeric_limits<double>::infinity() : 0);
}

}  // namespace opaline::bake
