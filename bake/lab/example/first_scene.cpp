#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "bake/lab/example/scene_parts.h"
#include "bake/lab/example/solid_mesh.h"

namespace opaline::bake {
namespace {

constexpr double kFirstSink = 0.4;  // [mm] of what stands on the floor

// Half a head, x toward its ear, as both halves are alike.
double monkey_distance(const glm::dvec3& p) {
    constexpr double kLower = 60;  // of the chin below the floor
    const glm::dvec3 q(std::abs(p.x), p.y + kLower, p.z);
    double d = ellipsoid(q - glm::dvec3(0, 300, 0), {235, 225, 230});
    d = smooth_union(d, ellipsoid(q - glm::dvec3(0, 150, 165), {165, 130, 135}), 70);  // muzzle
    d = smooth_union(d, ellipsoid(q - glm::dvec3(95, 372, 195), {95, 36, 50}), 45);    // brow
    d = smooth_union(d, ellipsoid(q - glm::dvec3(0, 240, 285), {42, 32, 40}), 30);     // nose
    const double ear = ellipsoid(q - glm::dvec3(300, 330, -30), {115, 130, 42});
    const double dish = ellipsoid(q - glm::dvec3(310, 330, 20), {75, 88, 40});
    d = smooth_union(d, smooth_intersection(ear, -dish, 25), 40);
    d = smooth_union(d, glm::distance(q, {92, 305, 190}) - 56, 12);  // eye
    return smooth_intersection(d, -kFirstSink - p.y, 20);            // flat where it stands
}

}  // namespace

TriangleMesh make_monkey_head() {
    constexpr double kTurn = 0.35;  // [rad] toward +x
    const ScalarField field = [c = std::cos(kTurn), s = std::sin(kTurn)](const glm::dvec3& p) {
        return monkey_distance({c * p.x - s * p.z, p.y, s * p.x + c * p.z});
    };
    TriangleMesh mesh = polygonize(field, {{-460, -40, -460}, {460, 560, 460}}, 16);
    remesh(field, {.shortest = 14, .longest = 40, .deviation = 1.2}, mesh);
    return mesh;
}

TriangleMesh make_torus(glm::dvec3 place, const TorusOptions& options) {
    TriangleMesh mesh;
    const glm::dvec3 centre = place + glm::dvec3(0, options.tube - kFirstSink, 0);
    for (unsigned i = 0; i < options.along; ++i) {
        const double turn = 2 * std::numbers::pi * i / options.along;
        const glm::dvec3 outward(std::sin(turn), 0, std::cos(turn));
        for (unsigned j = 0; j < options.around; ++j) {
            const double roll = 2 * std::numbers::pi * j / options.around;
            const glm::dvec3 normal = std::cos(roll) * outward + glm::dvec3(0, std::sin(roll), 0);
            mesh.position.push_back(centre + options.ring * outward + options.tube * normal);
            mesh.normal.push_back(normal);
        }
    }
    const auto vertex = [&](unsigned i, unsigned j) -> std::uint32_t {
        return i % options.along * options.around + j % options.around;
    };
    for (unsigned i = 0; i < options.along; ++i) {
        for (unsigned j = 0; j < options.around; ++j) {
            const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                                d = vertex(i, j + 1);
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
        }
    }
    return mesh;
}

TriangleMesh make_cube(glm::dvec3 place, double side, double turn) {
    const glm::dvec3 x(side * std::cos(turn), 0, -side * std::sin(turn)), y(0, side, 0),
        z(side * std::sin(turn), 0, side * std::cos(turn));
    const glm::dvec3 low = place - (x + z) / 2.0 - glm::dvec3(0, kFirstSink, 0);
    TriangleMesh mesh;
    append_grid(mesh, 1, 1, low + z, x, y);
    append_grid(mesh, 1, 1, low + x + z, -z, y);
    append_grid(mesh, 1, 1, low + x, -x, y);
    append_grid(mesh, 1, 1, low, z, y);
    append_grid(mesh, 1, 1, low + y + z, x, -z);
    append_grid(mesh, 1, 1, low, x, z);
    return mesh;
}

}  // namespace opaline::bake
