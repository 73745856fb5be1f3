#include "bake/single/light_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/single/inner_triangles.h"
#include "bake/single/spatial_order.h"

namespace opaline::bake {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float cross2(glm::vec2 a, glm::vec2 b) {
    return a.x * b.y - a.y * b.x;
}

void clear(std::vector<LightPixel>& layer, std::size_t pixels) {
    layer.assign(pixels, {-kInfinity, formats::kNone});
}

// Pixels whose centres lie in [low, high], clipped to the map.
struct Span {
    std::int32_t first, last;
};
Span pixel_span(float low, float high, std::uint32_t size) {
    const float end = static_cast<float>(size) - 1.0f;
    // Clamped as floats: a blocker far outside would overflow the integer.
    return {static_cast<std::int32_t>(std::ceil(std::clamp(low - 0.5f, 0.0f, end + 1.0f))),
            static_cast<std::int32_t>(std::floor(std::clamp(high - 0.5f, -1.0f, end)))};
}

ProjectedTriangle project_triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, float area) {
    const glm::vec2 ab(b - a), ac(c - a);
    const float inverse = 1.0f / area, zb = b.z - a.z, zc = c.z - a.z;
    ProjectedTriangle t;
    t.corner = glm::vec2(a);
    t.z = a.z;
    t.second = inverse * glm::vec2(ac.y, -ac.x);
    t.third = inverse * glm::vec2(-ab.y, ab.x);
    t.slope = zb * t.second + zc * t.third;
    return t;
}

// Draws a triangle and keeps its record if it is on top of something; whether it is.
bool draw(LightView& view, std::vector<LightPixel>& layer, std::uint32_t id, glm::vec3 a,
          glm::vec3 b, glm::vec3 c, float area) {
    const std::uint32_t size = view.size;
    const Span rows = pixel_span(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), size);
    const Span columns = pixel_span(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), size);
    if (rows.first > rows.last || columns.first > columns.last) {
        return false;
    }
    const ProjectedTriangle t = project_triangle(a, b, c, area);
    bool drawn = false;
    for (std::int32_t j = rows.first; j <= rows.last; ++j) {
        LightPixel* row = &layer[static_cast<std::size_t>(j) * size];
        for (std::int32_t i = columns.first; i <= columns.last; ++i) {
            const glm::vec2 from = glm::vec2(i, j) + 0.5f - t.corner;
            const float tb = glm::dot(from, t.second), tc = glm::dot(from, t.third);
            if (tb >= 0 && tc >= 0 && tb + tc <= 1) {
                const float z = t.z + glm::dot(from, t.slope);
                if (z > row[i].z) {
                    row[i] = {z, id};
                    drawn = true;
                }
            }
        }
    }
    if (drawn) {
        view.triangle[id] = t;
    }
    return drawn;
}

// The column through a point, on the plane of a triangle.
struct Crossing {
    bool holds = false;  // the column goes through the triangle itself
    float z = 0;
};

Crossing cross_triangle(const ProjectedTriangle& t, glm::vec3 p) {
    const glm::vec2 from = glm::vec2(p) - t.corner;
    const float tb = glm::dot(from, t.second), tc = glm::dot(from, t.third);
    constexpr float kMargin = 1e-4f;  // neighbours overlap rather than leave a gap by rounding
    return {tb >= -kMargin && tc >= -kMargin && tb + tc <= 1 + kMargin,
            t.z + glm::dot(from, t.slope)};
}

using Corner = std::array<std::size_t, 4>;

// The four pixels around a point, the nearest first.
Corner nearest_pixels(const LightView& view, glm::vec3 p) {
    const float last = static_cast<float>(view.size) - 2.0f;
    const float x = std::clamp(p.x - 0.5f, 0.0f, last), y = std::clamp(p.y - 0.5f, 0.0f, last);
    const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
    const std::size_t di = x - static_cast<float>(i) > 0.5f ? 1 : 0;
    const std::size_t dj = y - static_cast<float>(j) > 0.5f ? 1 : 0;
    const std::size_t size = view.size;
    return {(j + dj) * size + i + di, (j + dj) * size + i + 1 - di, (j + 1 - dj) * size + i + di,
            (j + 1 - dj) * size + i + 1 - di};
}

// Whether a layer passes above the point.
struct Above {
    bool yes = false, sure = true;
};

Above passes_above(const LightView& view, const std::vector<LightPixel>& layer,
                   const Corner& pixels, glm::vec3 p) {
    float low = kInfinity, high = -kInfinity;
    bool all = true;
    for (const std::size_t pixel : pixels) {
        const float z = layer[pixel].z;
        all = all && z > -kInfinity;
        low = std::min(low, z);
        high = std::max(high, z);
    }
    if (high == -kInfinity) {
        return {false, true};
    }
    // Clear by more than the layer varies between the pixels: no need for its triangles.
    const float spread = all ? high - low : 0.0f;
    if (all && low > p.z + spread) {
        return {true, true};
    }
    if (high < p.z - spread) {
        return {false, true};
    }
    for (const std::size_t pixel : pixels) {
        if (layer[pixel].triangle != formats::kNone) {
            const Crossing c = cross_triangle(view.triangle[layer[pixel].triangle], p);
            if (c.holds) {
                return {c.z > p.z, true};
            }
        }
    }
    return {layer[pixels[0]].z > p.z, false};
}

// So that what is near in space is near in memory; the body's triangles stay the first.
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

BodyMesh make_body_mesh(const formats::Scene& scene, const RayScene& rays, std::uint32_t material,
                        const Context& context) {
    BodyMesh mesh;
    const std::vector<std::uint8_t> inner = find_inner_triangles(scene, rays, material, context);
    std::size_t next = 0;
    glm::vec3 low(kInfinity), high(-kInfinity);
    double edges = 0;
    for (const bool body : {true, false}) {
        for (const formats::Primitive& p : scene.primitives) {
            if ((p.material == material) != body) {
                continue;
            }
            const auto base = static_cast<std::uint32_t>(mesh.position.size());
            mesh.position.insert(mesh.position.end(), p.position.begin(), p.position.end());
            for (std::size_t i = 0; i + 2 < p.index.size(); i += 3) {
                const glm::uvec3 t(p.index[i], p.index[i + 1], p.index[i + 2]);
                if (body && inner[next++] != 0) {
                    continue;
                }
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

LightFrame make_light_frame(glm::vec3 toward_light, float radius, std::uint32_t size,
                            glm::vec2 jitter) {
    LightFrame frame;
    frame.w = toward_light;
    const glm::vec3 helper =
        std::abs(toward_light.x) < 0.5f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    frame.u = glm::normalize(glm::cross(helper, toward_light));
    frame.v = glm::cross(frame.w, frame.u);
    // A border of two pixels, and one that the jitter moves through.
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

void render_light_view(const BodyMesh& mesh, const LightFrame& frame, std::uint32_t size,
                       const Interface<float>& boundary, LightView& view) {
    view.size = size;
    view.frame = frame;
    view.projected.resize(mesh.position.size());
    for (std::size_t i = 0; i < mesh.position.size(); ++i) {
        view.projected[i] = project(frame, mesh.position[i]);
    }
    view.triangle.resize(mesh.triangle.size());
    const std::size_t pixels = std::size_t{size} * size;
    clear(view.front, pixels);
    clear(view.back, pixels);
    if (mesh.triangle.size() > mesh.body_triangles) {
        clear(view.blocker, pixels);
    }
    constexpr float kEdgeOn = 1e-12f;  // [pixel^2] no pixel's centre is inside
    for (std::uint32_t id = 0; id < mesh.triangle.size(); ++id) {
        const glm::uvec3 t = mesh.triangle[id];
        const glm::vec3 a = view.projected[t.x], b = view.projected[t.y], c = view.projected[t.z];
        const float area = cross2(glm::vec2(b - a), glm::vec2(c - a));
        if (!(std::abs(area) > kEdgeOn)) {
            continue;
        }
        std::vector<LightPixel>& layer = id >= mesh.body_triangles ? view.blocker
                                         : area > 0                ? view.front
                                                                   : view.back;
        if (draw(view, layer, id, a, b, c, area) && &layer == &view.front) {
            ProjectedTriangle& drawn = view.triangle[id];
            const glm::vec2 slope = frame.pixels_per_metre * drawn.slope;
            drawn.cosine = 1.0f / std::sqrt(1.0f + glm::dot(slope, slope));
            drawn.entry = enter(drawn.cosine, boundary);
        }
    }
}

LightAnswer look_up(const LightView& view, glm::vec3 p, float tolerance) {
    const Corner pixels = nearest_pixels(view, p);
    LightAnswer answer;
    Above blocked;
    if (!view.blocker.empty()) {
        blocked = passes_above(view, view.blocker, pixels, p);
    }
    if (!blocked.yes || !blocked.sure) {
        const Above back = passes_above(view, view.back, pixels, p);
        const bool surely = back.yes && back.sure;
        blocked = {blocked.yes || back.yes, surely || (blocked.sure && back.sure)};
    }
    answer.lit = !blocked.yes;
    if (blocked.yes && blocked.sure) {
        return answer;
    }
    float low = kInfinity, high = -kInfinity;
    bool all = true, known = false;
    Crossing crossing;
    const ProjectedTriangle* entry = nullptr;
    std::uint32_t previous = formats::kNone;
    for (const std::size_t pixel : pixels) {
        const std::uint32_t id = view.front[pixel].triangle;
        if (id == formats::kNone) {
            all = false;
            continue;
        }
        if (id == previous) {
            continue;
        }
        previous = id;
        const Crossing c = cross_triangle(view.triangle[id], p);
        if (c.holds || entry == nullptr) {
            crossing = c;
            entry = &view.triangle[id];
        }
        low = std::min(low, c.z);
        high = std::max(high, c.z);
        if (c.holds) {
            known = c.z > p.z;
            low = c.z;
            break;
        }
    }
    known = known || (all && low > p.z && high - low < tolerance);
    answer.sure = blocked.sure && known;
    answer.lit = answer.lit && entry != nullptr;
    if (entry != nullptr) {
        answer.distance = std::max(crossing.z - p.z, 0.0f);
        answer.nearest = known ? answer.distance : std::max(low - (high - low) - p.z, 0.0f);
        answer.cosine = entry->cosine;
        answer.entry = entry->entry;
        const LightFrame& frame = view.frame;
        const glm::vec2 slope = frame.pixels_per_metre * entry->slope;
        answer.normal = answer.cosine * (frame.w - slope.x * frame.u - slope.y * frame.v);
    }
    return answer;
}

}  // namespace opaline::bake
