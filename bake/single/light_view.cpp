#include "bake/single/light_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bake/single/inner_triangles.h"

namespace opaline::bake {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float cross2(glm::vec2 a, glm::vec2 b) {
    return a.x * b.y - a.y * b.x;
}

void clear(LightLayer& layer, std::size_t pixels) {
    layer.triangle.assign(pixels, formats::kNone);
    layer.z.assign(pixels, -kInfinity);
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

void draw(LightLayer& layer, std::uint32_t size, std::uint32_t id, glm::vec3 a, glm::vec3 b,
          glm::vec3 c, float area) {
    const Span rows = pixel_span(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), size);
    const Span columns = pixel_span(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), size);
    if (rows.first > rows.last || columns.first > columns.last) {
        return;
    }
    const float inverse = 1.0f / area;
    const glm::vec2 ab(b - a), ac(c - a);
    const glm::vec2 start(static_cast<float>(columns.first) + 0.5f - a.x,
                          static_cast<float>(rows.first) + 0.5f - a.y);
    // Barycentric coordinates of b and c at the first centre, and their steps.
    float tb_row = cross2(start, ac) * inverse, tc_row = cross2(ab, start) * inverse;
    const float tb_x = ac.y * inverse, tb_y = -ac.x * inverse;
    const float tc_x = -ab.y * inverse, tc_y = ab.x * inverse;
    const float zb = b.z - a.z, zc = c.z - a.z;
    for (std::int32_t j = rows.first; j <= rows.last; ++j) {
        float tb = tb_row, tc = tc_row;
        const std::size_t row = static_cast<std::size_t>(j) * size;
        for (std::int32_t i = columns.first; i <= columns.last; ++i) {
            if (tb >= 0 && tc >= 0 && tb + tc <= 1) {
                const float z = a.z + tb * zb + tc * zc;
                const std::size_t pixel = row + static_cast<std::size_t>(i);
                if (z > layer.z[pixel]) {
                    layer.z[pixel] = z;
                    layer.triangle[pixel] = id;
                }
            }
            tb += tb_x;
            tc += tc_x;
        }
        tb_row += tb_y;
        tc_row += tc_y;
    }
}

// The column through a point, on the plane of a triangle.
struct Crossing {
    bool holds = false;  // the column goes through the triangle itself
    float z = 0;
    glm::vec2 slope{0};  // dz/dx, dz/dy, [m/m]
};

Crossing cross_triangle(const BodyMesh& mesh, const LightView& view, std::uint32_t id,
                        glm::vec3 p) {
    const glm::uvec3 t = mesh.triangle[id];
    const glm::vec3 a = view.projected[t.x], b = view.projected[t.y], c = view.projected[t.z];
    const glm::vec2 ab(b - a), ac(c - a), ap(p - a);
    const float area = cross2(ab, ac), inverse = 1.0f / area;
    const float tb = cross2(ap, ac) * inverse, tc = cross2(ab, ap) * inverse;
    const float zb = b.z - a.z, zc = c.z - a.z;
    Crossing crossing;
    constexpr float kMargin = 1e-4f;  // neighbours overlap rather than leave a gap by rounding
    crossing.holds = tb >= -kMargin && tc >= -kMargin && tb + tc <= 1 + kMargin;
    crossing.z = a.z + tb * zb + tc * zc;
    const float scale = inverse * view.frame.pixels_per_metre;
    crossing.slope = scale * glm::vec2(ac.y * zb - ab.y * zc, ab.x * zc - ac.x * zb);
    return crossing;
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

Above passes_above(const BodyMesh& mesh, const LightView& view, const LightLayer& layer,
                   const Corner& pixels, glm::vec3 p) {
    float low = kInfinity, high = -kInfinity;
    bool all = true;
    for (const std::size_t pixel : pixels) {
        const float z = layer.z[pixel];
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
        if (layer.triangle[pixel] != formats::kNone) {
            const Crossing c = cross_triangle(mesh, view, layer.triangle[pixel], p);
            if (c.holds) {
                return {c.z > p.z, true};
            }
        }
    }
    return {layer.z[pixels[0]] > p.z, false};
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
                       LightView& view) {
    view.size = size;
    view.frame = frame;
    view.projected.resize(mesh.position.size());
    for (std::size_t i = 0; i < mesh.position.size(); ++i) {
        view.projected[i] = project(frame, mesh.position[i]);
    }
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
        LightLayer& layer = id >= mesh.body_triangles ? view.blocker
                            : area > 0                ? view.front
                                                      : view.back;
        draw(layer, size, id, a, b, c, area);
    }
}

LightAnswer look_up(const BodyMesh& mesh, const LightView& view, glm::vec3 p, float tolerance) {
    const Corner pixels = nearest_pixels(view, p);
    LightAnswer answer;
    Above blocked;
    if (!view.blocker.z.empty()) {
        blocked = passes_above(mesh, view, view.blocker, pixels, p);
    }
    if (!blocked.yes || !blocked.sure) {
        const Above back = passes_above(mesh, view, view.back, pixels, p);
        const bool surely = back.yes && back.sure;
        blocked = {blocked.yes || back.yes, surely || (blocked.sure && back.sure)};
    }
    answer.lit = !blocked.yes;
    if (blocked.yes && blocked.sure) {
        return answer;
    }
    float low = kInfinity, high = -kInfinity;
    bool all = true, known = false, found = false;
    Crossing crossing;
    std::uint32_t previous = formats::kNone;
    for (const std::size_t pixel : pixels) {
        const std::uint32_t id = view.front.triangle[pixel];
        if (id == formats::kNone) {
            all = false;
            continue;
        }
        if (id == previous) {
            continue;
        }
        previous = id;
        const Crossing c = cross_triangle(mesh, view, id, p);
        if (c.holds || !found) {
            crossing = c;
            found = true;
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
    answer.lit = answer.lit && found;
    if (found) {
        answer.distance = std::max(crossing.z - p.z, 0.0f);
        answer.nearest = known ? answer.distance : std::max(low - (high - low) - p.z, 0.0f);
        const glm::vec2 slope = crossing.slope;
        answer.cosine = 1.0f / std::sqrt(1.0f + glm::dot(slope, slope));
        const LightFrame& frame = view.frame;
        answer.normal = answer.cosine * (frame.w - slope.x * frame.u - slope.y * frame.v);
    }
    return answer;
}

}  // namespace opaline::bake
