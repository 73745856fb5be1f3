#include "formats/gltf/complete_normals.h"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "formats/gltf/corner_normals.h"

namespace opaline::formats::gltf {

namespace {

bool lacks_direction(glm::vec3 n) {
    return n == glm::vec3(0.0f);
}

template <class T>
void append_copy(std::vector<T>& values, std::uint32_t of) {
    if (!values.empty()) {
        const T copy = values[of];
        values.push_back(copy);
    }
}

/// Gives every vertex the normal of its corners, and copies to those that have several.
std::size_t set_normals(const CornerNormals& corners, std::size_t first, Primitive& primitive) {
    const std::size_t before = primitive.position.size();
    primitive.normal.assign(before, glm::vec3(0.0f));
    std::vector<std::uint32_t> order(primitive.index.size());
    std::iota(order.begin(), order.end(), 0u);
    const std::vector<std::uint32_t> vertex = primitive.index;
    const auto group = [&](std::uint32_t corner) { return corners.group[first + corner]; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tuple(vertex[a], group(a), a) < std::tuple(vertex[b], group(b), b);
    });
    std::uint32_t current = kNone;  // the last corner that had a normal
    std::uint32_t copy = kNone;     // its vertex
    for (const std::uint32_t corner : order) {
        const glm::vec3 normal = corners.normal[first + corner];
        if (lacks_direction(normal)) {
            continue;  // of a triangle without an area: any vertex there will do
        }
        if (current == kNone || vertex[current] != vertex[corner]) {
            copy = vertex[corner];
            primitive.normal[copy] = normal;
        } else if (group(current) != group(corner) && normal != primitive.normal[copy]) {
            copy = static_cast<std::uint32_t>(primitive.position.size());
            append_copy(primitive.position, vertex[corner]);
            append_copy(primitive.texcoord, vertex[corner]);
            append_copy(primitive.color, vertex[corner]);
            append_copy(primitive.alpha, vertex[corner]);
            primitive.normal.push_back(normal);
        }
        primitive.index[corner] = copy;
        current = corner;
    }
    return primitive.position.size() - before;
}

/// The number of vertices without a direction that got one.
std::size_t repair_normals(const CornerNormals& corners, std::size_t first, Primitive& primitive) {
    std::size_t repaired = 0;
    for (std::size_t c = 0; c < primitive.index.size(); ++c) {
        glm::vec3& normal = primitive.normal[primitive.index[c]];
        if (lacks_direction(normal)) {
            normal = corners.normal[first + c];
            repaired += lacks_direction(normal) ? 0 : 1;
        }
    }
    return repaired;
}

}  // namespace

void complete_normals(std::span<Primitive> instance, double smooth_angle, ComputedNormals& made,
                      Report& report) {
    bool any_missing = false, any_open = false;
    for (const Primitive& p : instance) {
        any_missing = any_missing || p.normal.size() != p.position.size();
        any_open = any_open || std::any_of(p.normal.begin(), p.normal.end(), lacks_direction);
    }
    if (!any_missing && !any_open) return;
    std::vector<glm::vec3> position;
    std::vector<std::uint32_t> index;
    for (const Primitive& primitive : instance) {
        const auto first = static_cast<std::uint32_t>(position.size());
        position.insert(position.end(), primitive.position.begin(), primitive.position.end());
        for (const std::uint32_t i : primitive.index) {
            index.push_back(first + i);
        }
    }
    const auto computed = [&](bool wanted, double angle) {
        return wanted ? corner_normals(position, index, angle) : CornerNormals{};
    };
    const CornerNormals missing = computed(any_missing, smooth_angle * std::numbers::pi / 180);
    const CornerNormals open = computed(any_open, std::numbers::pi);
    std::size_t first = 0;
    for (Primitive& primitive : instance) {
        if (primitive.normal.size() != primitive.position.size()) {
            made.vertices += set_normals(missing, first, primitive);
            ++made.primitives;
        } else if (any_open) {
            if (const std::size_t repaired = repair_normals(open, first, primitive); repaired > 0) {
                report.warn(primitive.name,
                            std::to_string(repaired) +
                                " values of NORMAL had no direction and are computed "
                                "from the faces",
                            "recompute normals before export");
            }
        }
        first += primitive.index.size();
        const auto left =
            std::count_if(primitive.normal.begin(), primitive.normal.end(), lacks_direction);
        if (left > 0) {
            report.warn(primitive.name,
                        std::to_string(left) +
                            " vertices have neither a normal nor a face to "
                            "compute one from; they receive no light",
                        "delete loose vertices and triangles without area");
        }
    }
}

void tell_of_normals(const ComputedNormals& made, double smooth_angle, Report& report) {
    if (made.primitives == 0) return;
    std::string how = "flat, as glTF says";
    if (smooth_angle > 0) {
        how = std::to_string(smooth_angle);
        how.erase(how.find_last_not_of('0') + 1);
        how =
            "smooth across edges of less than " + how + (how.back() == '.' ? "0" : "") + " degrees";
    }
    report.notes.push_back("NORMAL is missing in " + std::to_string(made.primitives) +
                           " primitives and is computed: " + how +
                           (made.vertices > 0 ? "; " + std::to_string(made.vertices) +
                                                    " vertices are added where faces differ"
                                              : "") +
                           (smooth_angle > 0 ? "" : " (--smooth-normals DEGREES smooths)"));
}

}  // namespace opaline::formats::gltf
