#include "tests/properties/meshes.h"

#include <algorithm>

#include "tests/support/media.h"
#include "tests/support/sheets.h"
#include "tests/support/touching_bodies.h"

namespace opaline::tests {
namespace {

using formats::Primitive;

void append(Primitive& to, const Primitive& part) {
    const auto base = static_cast<std::uint32_t>(to.position.size());
    to.position.insert(to.position.end(), part.position.begin(), part.position.end());
    to.normal.insert(to.normal.end(), part.normal.begin(), part.normal.end());
    for (const std::uint32_t i : part.index) {
        to.index.push_back(base + i);
    }
}

// A triangle (a, b, c) becomes (a, m, c), (m, b, c) and the sliver (a, b, m), m almost on a b.
void split_into_slivers(Primitive& mesh) {
    const std::size_t triangles = mesh.index.size() / 3;
    for (std::size_t t = 0; t < triangles; t += 5) {
        const std::uint32_t a = mesh.index[3 * t], b = mesh.index[3 * t + 1],
                            c = mesh.index[3 * t + 2];
        const auto m = static_cast<std::uint32_t>(mesh.position.size());
        const glm::vec3 middle = 0.5f * (mesh.position[a] + mesh.position[b]);
        mesh.position.push_back(middle + 1e-5f * (mesh.position[c] - middle));
        mesh.normal.push_back(glm::normalize(mesh.normal[a] + mesh.normal[b]));
        mesh.index[3 * t + 1] = m;
        mesh.index.insert(mesh.index.end(), {m, b, c, a, b, m});
    }
}

}  // namespace

Primitive make_mesh(Shape shape) {
    switch (shape) {
        case Shape::box:
            return make_cube(2, false);
        case Shape::ball:
            return make_sphere(1);
        case Shape::quad:
            return make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 3);
        case Shape::plate:
            return make_plate(0.1f, 2);
        case Shape::cup:
            return make_cup();
        case Shape::shell: {
            Primitive shell = make_sphere(1);
            append(shell, turned_inside_out(make_sphere(1, 0.75f)));
            return shell;
        }
        case Shape::triangle:
            break;
    }
    Primitive triangle;
    triangle.position = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    triangle.normal.assign(3, {0, 0, 1});
    triangle.index = {0, 1, 2};
    return triangle;
}

Primitive with_flaw(Primitive mesh, Flaw flaw) {
    switch (flaw) {
        case Flaw::none:
            break;
        case Flaw::slivers:
            split_into_slivers(mesh);
            break;
        case Flaw::twice: {
            const std::size_t half = mesh.index.size() / 6 * 3;
            mesh.index.insert(mesh.index.end(), mesh.index.begin(),
                              mesh.index.begin() + static_cast<std::ptrdiff_t>(half));
            break;
        }
        case Flaw::no_area:
            for (std::size_t i = 0, end = mesh.index.size(); i + 1 < end; i += 7) {
                const std::uint32_t a = mesh.index[i], b = mesh.index[i + 1];
                mesh.index.insert(mesh.index.end(), {a, a, b, b, b, b});
            }
            break;
        case Flaw::flap: {
            const std::uint32_t a = mesh.index[0], b = mesh.index[1];
            const auto tip = static_cast<std::uint32_t>(mesh.position.size());
            mesh.position.push_back(mesh.position[a] + 0.5f * mesh.normal[a]);
            mesh.normal.push_back(
                glm::normalize(glm::cross(mesh.position[b] - mesh.position[a], mesh.normal[a])));
            mesh.index.insert(mesh.index.end(), {a, b, tip});
            break;
        }
        case Flaw::open:
            mesh.index.resize(mesh.index.size() - std::min<std::size_t>(mesh.index.size() - 3, 6));
            break;
        case Flaw::inside_out:
            mesh = turned_inside_out(std::move(mesh));
            break;
    }
    return mesh;
}

}  // namespace opaline::tests
