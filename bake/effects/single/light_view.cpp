#include "bake/effects/single/light_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/spatial_order.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kPoints = 4, kRays = 3;

struct Triangle {
    std::array<glm::vec3, 3> corner;
};

std::vector<Triangle> triangles_of(const formats::Scene& scene, std::uint32_t material) {
    std::vector<Triangle> all;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t i = 0; p.material == material && i + 2 < p.index.size(); i += 3) {
            all.push_back(
                {{p.position[p.index[i]], p.position[p.index[i + 1]], p.position[p.index[i + 2]]}});
        }
    }
    return all;
}

// Number of shells of the medium around the start of each ray: shells left minus shells entered on
// the way to infinity.
std::array<std::int32_t, RayPacket::kSize> count_shells(const RayScene& rays,
                                                        std::uint32_t material, LaneMask lanes,
                                                        RayPacket packet) {
    std::array<std::int32_t, RayPacket::kSize> shells{};
    constexpr int kMostCrossings = 256;  // bounds the work for a hostile mesh
    for (int i = 0; i < kMostCrossings; ++i) {
        packet.tfar.fill(std::numeric_limits<float>::infinity());
        const PacketHits hits = rays.closest(lanes, packet);
        std::int32_t any = 0;
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            if (lanes[lane] == 0 || hits.hit[lane] == 0) {
                lanes[lane] = 0;
                continue;
            }
            if (hits.material[lane] == material) {
                shells[lane] += hits.cosine[lane] > 0 ? 1 : hits.cosine[lane] < 0 ? -1 : 0;
            }
            packet.tnear[lane] =
                hits.distance[lane] + std::max(hits.error[lane], 1e-6f * hits.distance[lane]);
            any |= lanes[lane];
        }
        if (any == 0) break;
    }
    return shells;
}

// The rays of one triangle are one packet; its last four lanes stay empty.
bool lies_inside(const RayScene& rays, std::uint32_t material, const Triangle& triangle) {
    const auto& [a, b, c] = triangle.corner;
    const glm::vec3 across = glm::cross(b - a, c - a);
    const float area = glm::length(across);
    if (!(area > 0)) return false;
    const glm::vec3 normal = across / area;
    const glm::vec3 tangent = glm::normalize(b - a);
    const glm::vec3 other = glm::cross(normal, tangent);
    const std::array<glm::vec3, kRays> direction{
        normal, glm::normalize(normal + 0.7f * tangent + 0.4f * other),
        glm::normalize(normal - 0.5f * tangent - 0.6f * other)};
    const glm::vec3 reach = glm::max(glm::abs(b - a), glm::abs(c - a));
    constexpr float kClear = 4.0f;  // of the triangle itself, by rounding errors
    const float clear = kClear * clearance_bound(a, std::max({reach.x, reach.y, reach.z}));
    RayPacket packet{};
    packet.mask.fill(0xffffffffu);
    LaneMask lanes{};
    for (std::size_t p = 0; p < kPoints; ++p) {
        glm::vec3 weight(p == 3 ? 1.0f / 3.0f : 0.1f);
        if (p < 3) {
            weight[static_cast<glm::length_t>(p)] = 0.8f;
        }
        const glm::vec3 origin = weight.x * a + weight.y * b + weight.z * c + clear * normal;
        for (std::size_t r = 0; r < kRays; ++r) {
            const std::size_t lane = p * kRays + r;
            set_origin(packet, lane, origin);
            set_lane(packet, lanes, lane, direction[r]);
        }
    }
    const auto shells = count_shells(rays, material, lanes, packet);
    return *std::min_element(shells.begin(), shells.begin() + kPoints * kRays) >= 1;
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The column through a point, on the plane of a triangle.
struct Crossing {
    bool holds = false;  // the column goes through the triangle itself
    float z = 0;
};

inline Crossing cross_triangle(const BodyMesh& mesh, const LightView& view, std::uint32_t id,
                               glm::vec3 p) {
    const glm::uvec3 t = mesh.triangle[id];
    const glm::vec3 a = view.projected[t.x];
    const glm::vec3 ab = view.projected[t.y] - a, ac = view.projected[t.z] - a, from = p - a;
    const float inverse = 1.0f / (ab.x * ac.y - ab.y * ac.x);
    const float tb = inverse * (from.x * ac.y - from.y * ac.x);
    const float tc = inverse * (from.y * ab.x - from.x * ab.y);
    constexpr float kMargin = 1e-4f;  // neighbours overlap rather than leave a gap by rounding
    return {tb >= -kMargin && tc >= -kMargin && tb + tc <= 1 + kMargin,
            a.z + (tb * ab.z + tc * ac.z)};
}

using Corner = std::array<std::size_t, 4>;

// The four pixels around a point, the nearest first.
Corner nearest_pixels(const LightView& view, glm::vec3 p) {
    const float last = static_cast<float>(view.size) - 2.0f;
    const float x = std::clamp(p.x - 0.5f, 0.0f, last), y = std::clamp(p.y - 0.5f, 0.0f, last);
    const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
    const std::size_t di = x - static_cast<float>(i) > 0.5f ? 1 : 0;
    const std::size_t dj = y - static_cast<float>(j) > 0.5f ? 1 : 0;
    const std::uint32_t size = view.size;
    return {pixel_index(size, i + di, j + dj), pixel_index(size, i + 1 - di, j + dj),
            pixel_index(size, i + di, j + 1 - dj), pixel_index(size, i + 1 - di, j + 1 - dj)};
}

// True if an obstacle lies above the point.
struct Above {
    bool yes = false, sure = true;
};

Above passes_above(const BodyMesh& mesh, const LightView& view, const Corner& pixels, glm::vec3 p,
                   float margin) {
    const LightLayer& layer = view.obstacle;
    float low = kInfinity, high = -kInfinity;
    for (const std::size_t pixel : pixels) {
        low = std::min(low, layer.z[pixel]);
        high = std::max(high, layer.z[pixel]);
    }
    if (high == -kInfinity) {
        return {false, true};
    }
    // The layer is farther from the point than it varies between the pixels, so its triangles are
    // not needed.
    const bool all = low > -kInfinity;
    const float spread = (all ? high - low : 0.0f) + margin;
    if (all && low > p.z + spread) {
        return {true, true};
    }
    if (high < p.z - spread) {
        return {false, true};
    }
    std::uint32_t previous = formats::kNone;
    for (const std::size_t pixel : pixels) {
        const std::uint32_t id = layer.triangle[pixel];
        if (layer.z[pixel] > -kInfinity && id != previous) {
            previous = id;
            const Crossing c = cross_triangle(mesh, view, id, p);
            if (c.holds) {
                return {c.z > p.z, !(std::abs(c.z - p.z) < margin)};
            }
        }
    }
    return {layer.z[pixels[0]] > p.z, false};
}

constexpr float kFarthest = std::numeric_limits<float>::infinity();

// Spatial order for locality in memory; the body's triangles stay first.
void sort_in_space(BodyMesh& mesh) {
    const std::vector<std::uint32_t> order = spatial_order(mesh.position);
    std::vector<glm::vec3> position;
    std::vector<std::uint32_t> rank(order.size());
    for (const std::uint32_t v : order) {
        rank[v] = static_cast<std::uint32_t>(position.size());
        position.push_back(mesh.position[v]);
    }
    mesh.position = std::move(position);
    for (glm::uvec3& t : mesh.triangle) {
        t = {rank[t.x], rank[t.y], rank[t.z]};
    }
    const auto middle = mesh.triangle.begin() + mesh.body_triangles;
    const auto before = [](glm::uvec3 a, glm::uvec3 b) {
        return std::min({a.x, a.y, a.z}) < std::min({b.x, b.y, b.z});
    };
    std::stable_sort(mesh.triangle.begin(), middle, before);
    std::stable_sort(middle, mesh.triangle.end(), before);
}

}  // namespace

std::vector<std::uint8_t> find_inner_triangles(const formats::Scene& scene, const RayScene& rays,
                                               std::uint32_t material, const Context& context) {
    const std::vector<Triangle> triangles = triangles_of(scene, material);
    std::vector<std::uint8_t> inner;
    inner.reserve(triangles.size());
    constexpr std::size_t kBlock = 1024;
    for_each_block_in_order(
        triangles.size(), kBlock, context,
        [&](Range range) {
            std::vector<std::uint8_t> part;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                part.push_back(lies_inside(rays, material, triangles[i]) ? 1 : 0);
            }
            return part;
        },
        [&](Range, std::vector<std::uint8_t>&& part) {
            inner.insert(inner.end(), part.begin(), part.end());
        });
    inner.resize(triangles.size(), 0);
    return inner;
}

LightFrame make_light_frame(glm::vec3 toward_light, float radius, std::uint32_t size,
                            glm::vec2 jitter) {
    LightFrame frame;
    frame.w = toward_light;
    const glm::vec3 helper =
        std::abs(toward_light.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    frame.u = glm::normalize(glm::cross(helper, toward_light));
    frame.v = glm::cross(frame.w, frame.u);
    // A border of two pixels, and one for the jitter.
    const float inner = static_cast<float>(size) - 5.0f;
    frame.pixels_per_metre = radius > 0 ? inner / (2.0f * radius) : 1.0f;
    frame.offset = glm::vec2(0.5f * inner + 2.0f) + jitter;
    return frame;
}

glm::vec3 project(const LightFrame& frame, glm::vec3 position) {
    return {glm::dot(position, frame.u) * frame.pixels_per_metre + frame.offset.x,
            glm::dot(position, frame.v) * frame.pixels_per_metre + frame.offset.y,
            glm::dot(position, frame.w)};
}

LightAnswer look_up(const BodyMesh& mesh, const LightView& view, glm::vec3 p, float tolerance,
                    float margin) {
    const Corner pixels = nearest_pixels(view, p);
    const Above blocked = passes_above(mesh, view, pixels, p, margin);
    LightAnswer answer;
    if (blocked.yes && blocked.sure) return answer;
    float low = kInfinity, high = -kInfinity;
    bool all = true, known = false;
    Crossing crossing;
    std::uint32_t previous = formats::kNone;
    for (const std::size_t pixel : pixels) {
        if (!(view.front.z[pixel] > -kInfinity)) {
            all = false;
            continue;
        }
        const std::uint32_t id = view.front.triangle[pixel];
        if (id == previous) continue;
        previous = id;
        const Crossing c = cross_triangle(mesh, view, id, p);
        if (c.holds || answer.triangle == formats::kNone) {
            crossing = c;
            answer.triangle = id;
        }
        low = std::min(low, c.z);
        high = std::max(high, c.z);
        if (c.holds) {
            known = c.z > p.z + margin;
            low = c.z;
            break;
        }
    }
    const bool surely_above = all && low > p.z + margin;
    known = known || (surely_above && high - low < tolerance);
    answer.sure = blocked.sure && known;
    answer.uncertainty = answer.sure ? 0.0f : blocked.sure && surely_above ? high - low : kInfinity;
    answer.lit = !blocked.yes && answer.triangle != formats::kNone;
    if (answer.triangle != formats::kNone) {
        answer.distance = std::max(crossing.z - p.z, 0.0f);
        answer.nearest =
            known ? answer.distance : std::max(low - (high - low) - margin - p.z, 0.0f);
    }
    return answer;
}

BodyMesh make_body_mesh(const formats::Scene& scene, const RayScene& rays, std::uint32_t material,
                        const Context& context) {
    BodyMesh mesh;
    const std::vector<std::uint8_t> inner = find_inner_triangles(scene, rays, material, context);
    std::size_t next = 0;
    glm::vec3 low(kFarthest), high(-kFarthest);
    double edges = 0;
    for (const bool body : {true, false}) {
        for (const formats::Primitive& p : scene.primitives) {
            if ((p.material == material) != body) continue;
            const auto base = static_cast<std::uint32_t>(mesh.position.size());
            mesh.position.insert(mesh.position.end(), p.position.begin(), p.position.end());
            for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
                const glm::uvec3 t(p.index[i], p.index[i + 1], p.index[i + 2]);
                if (body && inner[next++] != 0) continue;
                mesh.triangle.push_back(base + t);
                if (body) {
                    edges += double{glm::distance(p.position[t.x], p.position[t.y])};
                    for (const std::uint32_t v : {t.x, t.y, t.z}) {
                        low = glm::min(low, p.position[v]);
                        high = glm::max(high, p.position[v]);
                    }
                }
            }
        }
        if (body) {
            mesh.body_triangles = static_cast<std::uint32_t>(mesh.triangle.size());
        }
    }
    if (mesh.body_triangles != 0) {
        mesh.centre = 0.5f * low + 0.5f * high;
        mesh.mean_edge = static_cast<float>(edges / mesh.body_triangles);
    }
    sort_in_space(mesh);
    for (glm::vec3& v : mesh.position) {
        v -= mesh.centre;
    }
    for (std::uint32_t t = 0; t < mesh.body_triangles; ++t) {
        for (glm::length_t k = 0; k < 3; ++k) {
            mesh.radius = std::max(mesh.radius, glm::length(mesh.position[mesh.triangle[t][k]]));
        }
    }
    return mesh;
}

}  // namespace opaline::bake
