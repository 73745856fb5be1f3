#include "bake/exchange/bounce_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/exchange/inside_media.h"
#include "bake/exchange/narrow_lobe.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/path_differentials/lobe.h"
#include "bake/receivers/receiver.h"

namespace opaline::bake {
namespace {

// Where a ray goes on, about the normal as third axis, and the share of its light that does.
struct LobeSample {
    glm::dvec3 direction{0, 0, 1};
    double share = 0;
};

// What masking leaves: Lambda of [Heitz2014], masking is 1 / (1 + Lambda).
double ggx_lambda(double cosine, double alpha) {
    const double tangent2 = (1 - cosine * cosine) / (cosine * cosine);
    return 0.5 * (std::sqrt(1 + alpha * alpha * tangent2) - 1);
}

// About one of the normals that the ray sees, drawn by u and v; the share is F G2 / G1.
LobeSample sample_lobe(const formats::Medium& medium, const glm::dvec3& to_eye, float u, float v) {
    const auto roughness = static_cast<double>(medium.roughness);
    const double alpha = roughness * roughness;
    const bool is_smooth = alpha < 1e-6;
    const glm::dvec3 m = is_smooth
                             ? glm::dvec3(0, 0, 1)
                             : sample_visible_normal(to_eye, {alpha, alpha}, static_cast<double>(u),
                                                     static_cast<double>(v))
                                   .m;
    const double cosine = std::clamp(glm::dot(to_eye, m), 0.0, 1.0);
    const glm::dvec3 onward = 2 * cosine * m - to_eye;
    if (!(onward.z > 0)) {
        return {};
    }
    const double masked = 1 + ggx_lambda(to_eye.z, alpha);
    return {onward, masked / (masked + ggx_lambda(onward.z, alpha)) *
                        fresnel_reflectance(cosine, static_cast<double>(medium.eta))};
}

// F_ext: what a boundary mirrors of even light from outside, twice the integral of F(c) c dc
// [Walsh1926], and by reciprocity below index 1.
double diffuse_reflectance(double eta) {
    constexpr double kMatched = 1e-5;
    if (std::abs(eta - 1) < kMatched) return 0;
    if (eta < 1) return 1 - (1 - diffuse_reflectance(1 / eta)) * eta * eta;
    const double n = eta, n2 = n * n, n4 = n2 * n2, above = n2 + 1, across = n4 - 1;
    return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
           n2 * (n2 - 1) * (n2 - 1) / (above * above * above) * std::log((n - 1) / (n + 1)) -
           2 * n * n2 * (n2 + 2 * n - 1) / (above * across) +
           8 * n4 * (n4 + 1) / (above * across * across) * std::log(n);
}

// Four directions around one, as far apart as halves of a texel of the sky: rays of a lobe are few
// for a texel, and this is the linear interpolation between texels, if with as many points.
std::array<glm::vec3, 4> spread_over_texel(const glm::vec3& direction) {
    constexpr float kHalf = 0.5f / kBounceCubemap;  // a quarter of a texel's width
    const Frame frame = make_frame(direction);
    std::array<glm::vec3, 4> around;
    for (std::size_t i = 0; i < around.size(); ++i) {
        const float x = i % 2 == 0 ? -kHalf : kHalf, y = i < 2 ? -kHalf : kHalf;
        around[i] = glm::normalize(direction + x * frame.u + y * frame.v);
    }
    return around;
}

bool is_boundary(const formats::Material& material) {
    return material.medium && !material.sheet;
}

}  // namespace

BounceGrid make_bounce_grid(std::uint32_t count) {
    BounceGrid grid;
    grid.side = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<float>(count))));
    grid.rays = count;
    grid.cells.reserve(count);
    const float width = 1 / static_cast<float>(grid.side);
    for (std::uint32_t row = 0; row < grid.side; ++row) {
        for (std::uint32_t column = 0; column < grid.side; ++column) {
            const float left = static_cast<float>(column) * width, right = left + width;
            const float low = static_cast<float>(row) * width, high = low + width;
            const float u = 0.5f * (left + right), v = 0.5f * (low + high);
            grid.cells.push_back(
                {.middle = to_hemisphere(u, v),
                 .across = to_hemisphere(std::min(right, 1.0f), v) - to_hemisphere(left, v),
                 .along = to_hemisphere(u, std::min(high, 1.0f)) - to_hemisphere(u, low)});
        }
    }
    return grid;
}

BounceGrid make_cut_grid(std::uint32_t count) {
    constexpr std::uint32_t kFewest = 256;
    constexpr double kCells = 0.64;
    if (count < kFewest) return make_bounce_grid(count);
    BounceGrid grid = make_bounce_grid(count_bounce_rays(kCells * count));
    grid.quarters = make_bounce_grid(4 * grid.count()).cells;
    grid.rays = count;
    return grid;
}

RayEnd end_of_ray(const formats::Scene& scene, const glm::vec3& origin, const glm::vec3& direction,
                  const PacketHits& hits, std::size_t lane) {
    return {.position = origin + hits.distance[lane] * direction,
            .direction = direction,
            .distance = hits.distance[lane],
            .error = hits.error[lane],
            .material = hits.material[lane],
            .side = side_of_hit(scene, hits, lane),
            .triangle = triangle_of_hit(hits, lane)};
}

MirroredRay mirror(const BounceSpace& space, const RayEnd& end, const formats::Rgb& share,
                   std::uint32_t number) {
    constexpr float kGrazing = 1e-3f;
    const formats::Material& material = space.scene.materials[end.material];
    if (!end.side.is_seen) {
        return {};
    }
    if (!is_boundary(material)) {
        return mirror_by_lobe(space, end, share, number);
    }
    const glm::vec3 normal = end.side.normal;
    const Frame frame = make_frame(normal);
    const glm::dvec3 to_eye(-glm::dot(frame.u, end.direction), -glm::dot(frame.v, end.direction),
                            std::max(-glm::dot(normal, end.direction), kGrazing));
    const auto u =
        random_uniform(0, RandomStage::bounce_rays, key_of({end.position, end.direction}));
    const LobeSample lobe = sample_lobe(*material.medium, glm::normalize(to_eye), u[0], u[1]);
    return {.origin = end.position + end.error * normal,
            .direction = glm::normalize(frame.to_world(glm::vec3(lobe.direction))),
            .share = static_cast<float>(lobe.share) * share,
            .number = number};
}

float share_of_radiosity(const formats::Material& material, float mirrored) {
    if (!is_boundary(material)) return 1;
    const double entering = 1 - diffuse_reflectance(static_cast<double>(material.medium->eta));
    return static_cast<float>((1 - static_cast<double>(mirrored)) / entering);
}

float share_beside_lobe(const BounceTree& tree, std::uint32_t node, float mirrored) {
    constexpr float kNothingElse = 1e-4f;  // of such metals rounding is all that is left
    const float beside = 1 - tree.mirrored(node);
    return beside > kNothingElse ? std::max(0.0f, 1 - mirrored) / beside : 0;
}

float share_of_own(const BounceSpace& space, const BounceTree& tree, std::uint32_t node,
                   const RayEnd& end, const MirroredRay& on, float arriving) {
    return on.of_lobe > 0 || tree.mirrored(node) > 0
               ? share_beside_lobe(tree, node, on.of_lobe)
               : share_of_radiosity(space.scene.materials[end.material], on.largest() / arriving);
}

std::uint64_t follow_mirrored(const BounceSpace& space, const BounceTree& tree,
                              std::vector<MirroredRay> open, std::vector<MirroredNode>& found) {
    // Boundaries that face each other mirror a few hundredths of the arriving light, except at
    // grazing angles.
    constexpr std::uint16_t kMostMirrors = 4;
    constexpr float kFaint = 1e-5f;  // of the first ray's light: what is left stays where it is
    constexpr std::size_t kLanes = RayPacket::kSize;
    const auto add = [&](std::uint32_t node, const MirroredRay& ray, const formats::Rgb& share) {
        if (node != formats::kNone) {
            found.push_back({node, share, ray.number});
        }
    };
    std::uint64_t traced = 0;
    while (!open.empty()) {
        std::vector<MirroredRay> next;
        for (std::size_t begin = 0; begin < open.size(); begin += kLanes) {
            const std::span<const MirroredRay> some =
                std::span(open).subspan(begin, std::min(kLanes, open.size() - begin));
            traced += some.size();
            const PacketHits hits = closest_of(space.rays, some);
            for (std::size_t i = 0; i < some.size(); ++i) {
                MirroredRay ray = some[i];
                if (hits.hit[i] == 0) {
                    if (ray.of_lobe > 0) {
                        for (const glm::vec3& d : spread_over_texel(ray.direction)) {
                            add(tree.sky_node(d), ray, 0.25f * ray.share);
                        }
                    } else {
                        add(tree.sky_node(ray.direction), ray, ray.share);
                    }
                    continue;
                }
                const RayEnd end = end_of_ray(space.scene, ray.origin, ray.direction, hits, i);
                if (go_on_inside(space, end, ray)) {
                    if (ray.inside < kMostInside && !(ray.largest() < kFaint)) next.push_back(ray);
                    continue;
                }
                if (!end.side.is_seen) continue;
                const std::uint32_t node =
                    tree.find(end.position - end.triangle.offset,
                              {end.material, end.side.behind, end.side.normal}, 0);
                MirroredRay on = mirror(space, end, ray.share, ray.number);
                on.mirrors = ray.mirrors + 1, on.inside = ray.inside, on.medium = ray.medium;
                if (on.mirrors >= kMostMirrors || on.largest() < kFaint) {
                    const std::uint32_t irradiance = on.of_lobe > 0 && node != formats::kNone
                                                         ? tree.irradiance_node(node)
                                                         : formats::kNone;
                    add(irradiance, ray, on.share);
                    if (irradiance == formats::kNone) {
                        on = {};
                    }
                } else if (on.largest() > 0) {
                    next.push_back(on);
                }
                if (node == formats::kNone) continue;
                add(node, ray, share_of_own(space, tree, node, end, on, ray.largest()) * ray.share);
            }
        }
        open = std::move(next);
    }
    return traced;
}

}  // namespace opaline::bake
