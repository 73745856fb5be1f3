#include "bake/accuracy/check_point.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "bake/base/frame.h"
#include "bake/base/rng.h"

namespace opaline::bake {

std::vector<CheckPoint> make_check_points(std::span<const ReceiverSet> sets,
                                          std::span<const std::uint32_t> drawn) {
    std::vector<CheckPoint> checked;
    checked.reserve(drawn.size());
    for (const std::uint32_t v : drawn) {
        const ReceiverSet& set = set_of(sets, v);
        CheckPoint point;
        point.primitive = set.primitive;
        point.material = set.material;
        point.vertex = {v, v, v};
        point.receiver = set.outside[v - set.first];
        point.body = set.inside[v - set.first];
        point.key = v;
        checked.push_back(point);
    }
    return checked;
}

void turn_thin_walled(const formats::Scene& scene, std::span<CheckPoint> points) {
    for (CheckPoint& point : points) {
        point.behind =
            scene.materials[point.material].sheet.has_value() && std::popcount(point.key) % 2 == 1;
    }
}

void turn_views(std::span<const glm::vec3> normals, std::uint64_t seed,
                std::span<CheckPoint> points) {
    constexpr std::uint32_t kOfViews = 0xffffffffu;  // no sample of the truth has that number
    constexpr double kLeast = 0.18;                  // of the squared cosine
    constexpr float kSeen = 0.2f;
    for (CheckPoint& point : points) {
        const auto u = random_uniform(seed, RandomStage::check_points, point.key, kOfViews);
        if (point.body.normal == glm::vec3(0) || u[0] < 0.25f) {
            continue;
        }
        const double cosine = std::sqrt(kLeast + (1 - kLeast) * static_cast<double>(u[1]));
        const double sine = std::sqrt(1 - cosine * cosine);
        const double azimuth = 2 * std::numbers::pi * static_cast<double>(u[2]);
        const glm::vec3 view =
            make_frame(point.body.normal)
                .to_world(glm::vec3(
                    glm::dvec3(sine * std::cos(azimuth), sine * std::sin(azimuth), cosine)));
        const bool is_seen = std::ranges::all_of(
            point.vertex, [&](std::uint32_t v) { return glm::dot(normals[v], view) > kSeen; });
        point.to_eye = is_seen ? view : glm::vec3(0);
    }
}

}  // namespace opaline::bake
