#include "runtime/picture/band.h"

#include <algorithm>

namespace opaline::runtime {

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
