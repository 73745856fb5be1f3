#include "formats/gltf/tangents.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace opaline::formats::gltf {

namespace {

/// `v` without its part along `normal`, unit; zero where nothing is left.
glm::dvec3 unit_in_plane(glm::dvec3 v, glm::dvec3 normal) {
    const double size = glm::length(v);
    if (!(size > 0) || !std::isfinite(size)) return glm::dvec3(0.0);
    const glm::dvec3 flat = v / size - glm::dot(v / size, normal) * normal;
    const double left = glm::length(flat);
    return left > 1e-6 ? flat / left : glm::dvec3(0.0);
}

double angle_between(glm::dvec3 a, glm::dvec3 b) {
    const double sizes = glm::length(a) * glm::length(b);
    return sizes > 0 ? std::acos(std::clamp(glm::dot(a, b) / sizes, -1.0, 1.0)) : 0.0;
}

/// What triangles around a vertex say: plain ones and mirrored ones.
struct Votes {
    std::array<glm::dvec3, 2> direction{glm::dvec3(0.0), glm::dvec3(0.0)};
    std::array<double, 2> angle{};
};

void vote(const Primitive& p, const std::uint32_t* corner, std::vector<Votes>& votes) {
    std::array<glm::dvec3, 3> at;
    std::array<glm::dvec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
        at[k] = p.position[corner[k]];
        uv[k] = p.texcoord[corner[k]];
    }
    const glm::dvec3 e1 = at[1] - at[0], e2 = at[2] - at[0];
    const glm::dvec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
    const double area = d1.x * d2.y - d2.x * d1.y;
    if (area == 0) return;
    const double turn = area < 0 ? -1 : 1;  // dP/du and dP/dv but for a positive factor
    const glm::dvec3 along_u = turn * (d2.y * e1 - d1.y * e2);
    const glm::dvec3 along_v = turn * (d1.x * e2 - d2.x * e1);
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 normal(p.normal[corner[k]]);
        const glm::dvec3 tangent = unit_in_plane(along_u, normal);
        const double angle = angle_between(at[(k + 1) % 3] - at[k], at[(k + 2) % 3] - at[k]);
        // The image's y points up, v down.
        const std::size_t side = glm::dot(glm::cross(normal, tangent), along_v) < 0 ? 0 : 1;
        votes[corner[k]].direction[side] += angle * tangent;
        votes[corner[k]].angle[side] += angle;
    }
}

glm::vec4 with_sign(glm::dvec3 direction, float sign) {
    return direction == glm::dvec3(0.0) ? glm::vec4(0.0f) : glm::vec4(glm::vec3(direction), sign);
}

}  // namespace

std::vector<glm::vec4> turn_tangents(const std::vector<float>& stored, const Placement& placement) {
    const float handed = placement.is_mirrored ? -1.0f : 1.0f;
    std::vector<glm::vec4> turned(stored.size() / 4, glm::vec4(0.0f));
    for (std::size_t i = 0; i < turned.size(); ++i) {
        const glm::vec3 t(glm::dmat3(placement.at(i)) *
                          glm::dvec3(stored[4 * i], stored[4 * i + 1], stored[4 * i + 2]));
        if (std::isfinite(t.x + t.y + t.z)) {
            turned[i] = glm::vec4(t, stored[4 * i + 3] < 0 ? -handed : handed);
        }
    }
    return turned;
}

void complete_tangents(Primitive& primitive) {
    primitive.tangent.resize(primitive.position.size(), glm::vec4(0.0f));
    bool is_complete = true;
    for (std::size_t v = 0; v < primitive.tangent.size(); ++v) {
        glm::vec4& tangent = primitive.tangent[v];
        tangent = with_sign(unit_in_plane(glm::vec3(tangent), primitive.normal[v]), tangent.w);
        is_complete = is_complete && tangent.w != 0;
    }
    if (is_complete) return;
    std::vector<Votes> votes(primitive.position.size());
    for (std::size_t i = 0; i + 2 < primitive.index.size(); i += 3) {
        vote(primitive, &primitive.index[i], votes);
    }
    for (std::size_t v = 0; v < votes.size(); ++v) {
        if (primitive.tangent[v].w != 0) continue;
        const std::size_t side = votes[v].angle[1] > votes[v].angle[0] ? 1 : 0;
        primitive.tangent[v] = with_sign(
            unit_in_plane(votes[v].direction[side], primitive.normal[v]), side == 0 ? 1.0f : -1.0f);
    }
}

}  // namespace opaline::formats::gltf
