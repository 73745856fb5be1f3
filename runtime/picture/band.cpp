#include "runtime/picture/band.h"

#include <algorithm>

namespace opaline::runtime {
namespace {

bool is_finite_vertex(const GridVertex& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.w);
}

// Rows of the grid go down: a front, counter-clockwise to the eye, has a negative determinant.
bool is_back(const std::array<GridVertex, 3>& corner) {
    const GridVertex &a = corner[0], &b = corner[1], &c = corner[2];
    return a.x * (b.y * c.w - b.w * c.y) + a.y * (b.w * c.x - b.x * c.w) +
               a.w * (b.x * c.y - b.y * c.x) >
           0;
}

double dot_wide(formats::Vec3 a, double x, double y, double z) {
    return static_cast<double>(a.x) * x + static_cast<double>(a.y) * y +
           static_cast<double>(a.z) * z;
}

void extend(GridBox& box, double x, double y) {
    box.low_x = std::min(box.low_x, x);
    box.low_y = std::min(box.low_y, y);
    box.high_x = std::max(box.high_x, x);
    box.high_y = std::max(box.high_y, y);
}

}  // namespace

std::vector<GridVertex> project_vertices(std::span<const formats::Vec3> positions,
                                         const Camera& camera, const SampleGrid& grid) {
    const CameraFrame frame = camera_frame(camera);
    const double half_columns = 0.5 * grid.columns, half_rows = 0.5 * grid.rows;
    const double ex = static_cast<double>(camera.eye.x), ey = static_cast<double>(camera.eye.y),
                 ez = static_cast<double>(camera.eye.z);
    std::vector<GridVertex> vertices(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const double x = static_cast<double>(positions[v].x) - ex;
        const double y = static_cast<double>(positions[v].y) - ey;
        const double z = static_cast<double>(positions[v].z) - ez;
        const double w = -dot_wide(frame.backward, x, y, z);
        vertices[v] = {half_columns * (dot_wide(frame.right, x, y, z) / frame.tan_half_x + w),
                       half_rows * (w - dot_wide(frame.up, x, y, z) / frame.tan_half_y), w};
    }
    return vertices;
}

GridBox visible_box(const std::array<GridVertex, 3>& corner, double near_plane) {
    GridBox box;
    for (std::size_t i = 0; i < 3; ++i) {
        const GridVertex &a = corner[i], &b = corner[(i + 1) % 3];
        if (a.w >= near_plane) extend(box, a.x / a.w, a.y / a.w);
        if ((a.w >= near_plane) != (b.w >= near_plane)) {
            const double t = (near_plane - a.w) / (b.w - a.w);
            extend(box, (a.x + t * (b.x - a.x)) / near_plane, (a.y + t * (b.y - a.y)) / near_plane);
        }
    }
    return box;
}

SampleRange samples_within(double low, double high, std::uint32_t limit) {
    // A sample more on either side: the box is rounded, the edge functions decide.
    const double first = std::clamp(std::ceil(low - 0.5) - 1.0, 0.0, static_cast<double>(limit));
    const double end = std::clamp(std::floor(high - 0.5) + 2.0, 0.0, static_cast<double>(limit));
    return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(std::max(first, end))};
}

std::vector<GridTriangle> select_triangles(const formats::AssetView& asset,
                                           std::span<const GridVertex> vertices,
                                           const SampleGrid& grid) {
    std::vector<GridTriangle> triangles;
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        const auto indices = asset.index.subspan(primitive.first_index, primitive.index_count);
        for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
            GridTriangle triangle;
            triangle.primitive = p;
            std::array<GridVertex, 3> corner;
            for (std::size_t k = 0; k < 3; ++k) {
                triangle.vertex[k] = primitive.first_vertex + indices[i + k];
                corner[k] = vertices[triangle.vertex[k]];
            }
            if (!std::all_of(corner.begin(), corner.end(), is_finite_vertex)) continue;
            if (!primitive.shows_back() && is_back(corner)) continue;
            const GridBox box = visible_box(corner, grid.near_plane);
            if (!(box.low_x <= box.high_x)) continue;
            const SampleRange columns = samples_within(box.low_x, box.high_x, grid.columns);
            const SampleRange rows = samples_within(box.low_y, box.high_y, grid.rows);
            if (columns.first == columns.end || rows.first == rows.end) continue;
            triangle.first_row = rows.first;
            triangle.last_row = rows.end - 1;
            triangles.push_back(triangle);
        }
    }
    return triangles;
}

void reset_band(Band& band, std::uint32_t first_row, std::uint32_t rows, std::uint32_t columns) {
    band.first_row = first_row;
    band.rows = rows;
    band.columns = columns;
    const std::size_t samples = std::size_t{rows} * columns;
    band.inverse_distance.assign(samples, 0.0);
    band.triangle.assign(samples, Band::kNothing);
}

std::array<double, 3> EdgeFunctions::at(double x, double y) const {
    return {a[0] * x + b[0] * y + c[0], a[1] * x + b[1] * y + c[1], a[2] * x + b[2] * y + c[2]};
}

EdgeFunctions edge_functions(const std::array<GridVertex, 3>& corner) {
    // Rows of the adjugate of the matrix whose columns are the corners. Two triangles that share an
    // edge get exactly opposite functions for it: products commute and differences negate exactly.
    EdgeFunctions edges;
    for (std::size_t i = 0; i < 3; ++i) {
        const GridVertex &p = corner[(i + 1) % 3], &q = corner[(i + 2) % 3];
        edges.a[i] = p.y * q.w - p.w * q.y;
        edges.b[i] = p.w * q.x - p.x * q.w;
        edges.c[i] = p.x * q.y - p.y * q.x;
    }
    const double determinant =
        corner[0].x * edges.a[0] + corner[0].y * edges.b[0] + corner[0].w * edges.c[0];
    if (!std::isfinite(determinant) || determinant == 0) return edges;
    // Seen from behind: the same functions with the sign that makes the inside positive.
    const double sign = determinant < 0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < 3; ++i) {
        edges.a[i] *= sign;
        edges.b[i] *= sign;
        edges.c[i] *= sign;
    }
    const double inverse = 1.0 / (sign * determinant);
    edges.inverse_determinant = std::isfinite(inverse) ? inverse : 0.0;
    return edges;
}

void draw_triangle(Band& band, std::uint32_t number, const GridTriangle& triangle,
                   std::span<const GridVertex> vertices, const SampleGrid& grid,
                   const SampleTest& sees) {
    const std::array<GridVertex, 3> corner{
        vertices[triangle.vertex[0]], vertices[triangle.vertex[1]], vertices[triangle.vertex[2]]};
    const EdgeFunctions edges = edge_functions(corner);
    if (edges.inverse_determinant == 0) return;
    const GridBox box = visible_box(corner, grid.near_plane);
    const SampleRange columns = samples_within(box.low_x, box.high_x, grid.columns);
    const std::uint32_t first = std::max(triangle.first_row, band.first_row);
    const std::uint32_t last = std::min(triangle.last_row, band.first_row + band.rows - 1);
    const double nearest = 1.0 / grid.near_plane;

    std::array<bool, 3> owns_edge{};
    for (std::size_t i = 0; i < 3; ++i) {
        owns_edge[i] = edges.a[i] > 0 || (edges.a[i] == 0 && edges.b[i] > 0);
    }
    const auto is_inside = [&](double e, std::size_t i) {
        return e > 0 || (e == 0 && owns_edge[i]);
    };
    for (std::uint32_t row = first; row <= last; ++row) {
        const std::size_t start = std::size_t{row - band.first_row} * band.columns;
        for (std::uint32_t column = columns.first; column < columns.end; ++column) {
            const auto e = edges.at(column + 0.5, row + 0.5);
            if (!is_inside(e[0], 0) || !is_inside(e[1], 1) || !is_inside(e[2], 2)) continue;
            const double inverse_distance = (e[0] + e[1] + e[2]) * edges.inverse_determinant;
            if (inverse_distance > band.inverse_distance[start + column] &&
                inverse_distance <= nearest && (!sees || sees(e, column, row))) {
                band.inverse_distance[start + column] = inverse_distance;
                band.triangle[start + column] = number;
            }
        }
    }
}

}  // namespace opaline::runtime
