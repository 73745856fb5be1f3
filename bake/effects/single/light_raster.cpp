#include <algorithm>
#include <limits>

#include "bake/effects/single/light_view.h"
#include "bake/base/vector8.h"

namespace opaline::bake {
namespace {

static_assert(kStrip == kVector);
constexpr Float8 kLanes{0, 1, 2, 3, 4, 5, 6, 7};

// Pixels whose centres lie in (low, high], clipped to the map. The half-open interval gives a
// centre on a shared edge to exactly one triangle.
struct Span {
    std::uint32_t begin, end;
};
OPALINE_INLINE Span pixel_span(float low, float high, float size) {
    // Clamped before the conversion, because a blocker far outside would overflow the integer.
    return {static_cast<std::uint32_t>(lesser(greater(low, 0.0f), size) + 0.5f),
            static_cast<std::uint32_t>(lesser(greater(high, 0.0f), size) + 0.5f)};
}

// Weights of the second and third corner and depth, linear in the pixel.
struct Planes {
    float second_x, second_y, third_x, third_y, slope_x, slope_y;
};
OPALINE_INLINE Planes planes_of(float abx, float aby, float abz, float acx, float acy, float acz,
                                float area) {
    const float inverse = 1.0f / area;
    const float bx = inverse * acy, by = inverse * -acx, cx = inverse * -aby, cy = inverse * abx;
    return {bx, by, cx, cy, abz * bx + acz * cx, abz * by + acz * cy};
}

// Draws the triangle where it is on top. `from`: first corner, relative to pixel (0, 0).
OPALINE_INLINE void draw(const Planes& planes, const glm::vec3& corner, Span rows, Span columns,
                         std::uint32_t id, std::size_t size, float* layer_z,
                         std::uint32_t* layer_id) {
    for (std::uint32_t i = columns.begin & ~(kStrip - 1); i < columns.end; i += kStrip) {
        const Float8 x = kLanes + (static_cast<float>(i) + 0.5f - corner.x);
        const Float8 second = x * planes.second_x, third = x * planes.third_x;
        const Float8 height = x * planes.slope_x + corner.z;
        float* z = layer_z + i * size + kStrip * rows.begin;
        std::uint32_t* triangle = layer_id + i * size + kStrip * rows.begin;
        for (std::uint32_t j = rows.begin; j < rows.end; ++j, z += kStrip, triangle += kStrip) {
            const float y = static_cast<float>(j) + 0.5f - corner.y;
            const Float8 tb = second + y * planes.second_y, tc = third + y * planes.third_y;
            const Float8 here = height + y * planes.slope_y, before = load8(z);
            const Int8 on_top = (tb >= 0.0f) & (tc >= 0.0f) & (tb + tc <= 1.0f) & (here > before);
            Int8 ids;
            __builtin_memcpy(&ids, triangle, sizeof ids);
            store8(on_top ? here : before, z);
            store8(on_top ? Int8{} + static_cast<std::int32_t>(id) : ids, triangle);
        }
    }
}

struct Target {
    const glm::vec3* projected;
    const glm::uvec3* triangle;
    std::uint32_t body_triangles, triangles;
    std::uint32_t size;
    float* front_z;
    std::uint32_t* front_id;
    float* obstacle_z;
    std::uint32_t* obstacle_id;
    glm::vec2* slope;
};

}  // namespace

OPALINE_VECTOR_CLONES
void project_vertices(const LightFrame& frame, const glm::vec3* position, std::size_t count,
                      glm::vec3* projected);
OPALINE_VECTOR_CLONES
void draw_triangles(const Target& target);

void project_vertices(const LightFrame& frame, const glm::vec3* position, std::size_t count,
                      glm::vec3* projected) {
    const glm::vec3 u = frame.u, v = frame.v, w = frame.w;
    const float scale = frame.pixels_per_metre, x0 = frame.offset.x, y0 = frame.offset.y;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = position[i].x, y = position[i].y, z = position[i].z;
        projected[i].x = (x * u.x + y * u.y + z * u.z) * scale + x0;
        projected[i].y = (x * v.x + y * v.y + z * v.z) * scale + y0;
        projected[i].z = x * w.x + y * w.y + z * w.z;
    }
}

void draw_triangles(const Target& target) {
    const Target t = target;
    const float size = static_cast<float>(t.size);
    constexpr float kEdgeOn = 1e-12f;  // [pixel^2] no pixel's centre is inside
    for (std::uint32_t id = 0; id < t.triangles; ++id) {
        const glm::uvec3& index = t.triangle[id];
        const glm::vec3 a = t.projected[index.x], b = t.projected[index.y],
                        c = t.projected[index.z];
        const float abx = b.x - a.x, aby = b.y - a.y, abz = b.z - a.z;
        const float acx = c.x - a.x, acy = c.y - a.y, acz = c.z - a.z;
        const float area = abx * acy - aby * acx;
        if (!(greater(area, -area) > kEdgeOn)) {  // also NaN
            continue;
        }
        const Span rows =
            pixel_span(lesser(lesser(a.y, b.y), c.y), greater(greater(a.y, b.y), c.y), size);
        const Span columns =
            pixel_span(lesser(lesser(a.x, b.x), c.x), greater(greater(a.x, b.x), c.x), size);
        if (rows.begin >= rows.end || columns.begin >= columns.end) continue;
        const Planes planes = planes_of(abx, aby, abz, acx, acy, acz, area);
        const bool front = area > 0 && id < t.body_triangles;
        draw(planes, a, rows, columns, id, t.size, front ? t.front_z : t.obstacle_z,
             front ? t.front_id : t.obstacle_id);
        t.slope[id].x = planes.slope_x;
        t.slope[id].y = planes.slope_y;
    }
}

void render_light_view(const BodyMesh& mesh, const LightFrame& frame, std::uint32_t size,
                       LightView& view) {
    view.size = size;
    view.frame = frame;
    view.projected.resize(mesh.position.size());
    project_vertices(frame, mesh.position.data(), mesh.position.size(), view.projected.data());
    view.slope.resize(mesh.triangle.size());
    const std::size_t pixels = pixel_index(size, size + kStrip - 1, 0);
    for (LightLayer* layer : {&view.front, &view.obstacle}) {
        layer->z.assign(pixels, -std::numeric_limits<float>::infinity());
        layer->triangle.resize(pixels);  // read only where something was drawn
    }
    draw_triangles({view.projected.data(), mesh.triangle.data(), mesh.body_triangles,
                    static_cast<std::uint32_t>(mesh.triangle.size()), size, view.front.z.data(),
                    view.front.triangle.data(), view.obstacle.z.data(),
                    view.obstacle.triangle.data(), view.slope.data()});
}

}  // namespace opaline::bake
