#include "formats/gltf/choose_origin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "formats/gltf/read_accessor.h"

namespace opaline::formats::gltf {

namespace {

struct Box {
    glm::dvec3 low{std::numeric_limits<double>::infinity()};
    glm::dvec3 high{-std::numeric_limits<double>::infinity()};

    void add(glm::dvec3 p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    bool is_empty() const { return !(low.x <= high.x); }
};

/// Bounds in the mesh's frame and file units, without primitives that read_primitive will refuse.
Box bounds_of(const Document& document, const Mesh& mesh, const std::vector<Bytes>& buffers) {
    Box box;
    for (const MeshPrimitive& primitive : mesh.primitives) {
        const auto position = primitive.attributes.find("POSITION");
        if (primitive.mode < Mode::triangles || position == primitive.attributes.end()) continue;
        const Accessor& accessor = document.accessors[position->second];
        if (accessor.is_matrix || accessor.components != 3) continue;
        const std::vector<float> value = read_floats(document, buffers, position->second).value;
        for (std::size_t i = 0; i + 2 < value.size(); i += 3) {
            const glm::dvec3 p(value[i], value[i + 1], value[i + 2]);
            if (std::isfinite(p.x + p.y + p.z)) {
                box.add(p);
            }
        }
    }
    return box;
}

double origin_along_axis(double centre, double radius) {
    constexpr double kNear = 16;  // [radii]
    if (!std::isfinite(centre) || !(radius > 0) || std::abs(centre) <= kNear * radius) return 0;
    int exponent = 0;
    std::frexp(radius, &exponent);
    const double step = std::ldexp(1.0, exponent);  // in (radius, 2 radius]
    return step * std::round(centre / step);
}

double largest(const std::vector<float>& values) {
    double most = 0;
    for (const float value : values) {
        most = std::max(most, std::abs(static_cast<double>(value)));
    }
    return most;
}

/// Spacing of floats near a coordinate, relative to the length of an edge.
double coarseness(double coordinate, double edge) {
    constexpr double kSpacing{std::numeric_limits<float>::epsilon()};
    return edge > 0 ? kSpacing * coordinate / edge : 0;
}

}  // namespace

glm::dvec3 choose_origin(const Document& document, const std::vector<MeshInstance>& instances,
                         const std::vector<Bytes>& buffers, double metres_per_unit) {
    std::map<std::uint32_t, Box> meshes;
    Box scene;
    for (const MeshInstance& instance : instances) {
        const std::uint32_t mesh = document.nodes[instance.node].mesh;
        auto found = meshes.find(mesh);
        if (found == meshes.end()) {
            found = meshes.emplace(mesh, bounds_of(document, document.meshes[mesh], buffers)).first;
        }
        const Box& box = found->second;
        const auto add = [&](const glm::dmat4& world) {
            for (int corner = 0; corner < 8 && !box.is_empty(); ++corner) {
                const glm::dvec3 p((corner & 1) != 0 ? box.high.x : box.low.x,
                                   (corner & 2) != 0 ? box.high.y : box.low.y,
                                   (corner & 4) != 0 ? box.high.z : box.low.z);
                scene.add(metres_per_unit * glm::dvec3(world * glm::dvec4(p, 1.0)));
            }
        };
        if (instance.joints.empty()) {
            add(instance.world);
        }
        for (const glm::dmat4& joint : instance.joints) {
            add(joint);
        }
    }
    if (scene.is_empty()) return glm::dvec3(0);
    const glm::dvec3 half = 0.5 * scene.high - 0.5 * scene.low;
    const glm::dvec3 centre = scene.low + half;
    const double radius = std::max({half.x, half.y, half.z});
    return {origin_along_axis(centre.x, radius), origin_along_axis(centre.y, radius),
            origin_along_axis(centre.z, radius)};
}

void warn_of_coarse_positions(const PrimitiveData& stored, const Primitive& placed,
                              glm::dvec3 origin, Report& report) {
    constexpr double kCoarse = 0.01;
    constexpr std::size_t kTriangles = 10'000;  // evenly spaced, whose edges stand for all
    const std::size_t step = 3 * (1 + placed.index.size() / 3 / kTriangles);
    double edges = 0, stored_edges = 0, in_frame = 0, in_world = 0;
    std::size_t count = 0;
    const auto corner = [&](std::uint32_t v) {
        const float* p = &stored.position[3 * std::size_t{v}];
        return glm::dvec3(p[0], p[1], p[2]);
    };
    for (std::size_t i = 0; i + 2 < placed.index.size(); i += step) {
        for (std::size_t k = 0; k < 3; ++k, ++count) {
            const std::uint32_t a = placed.index[i + k], b = placed.index[i + (k + 1) % 3];
            edges += glm::distance(glm::dvec3(placed.position[a]), glm::dvec3(placed.position[b]));
            stored_edges += glm::distance(corner(a), corner(b));
        }
    }
    const double mean = count > 0 ? edges / static_cast<double>(count) : 0;
    const double stored_mean = count > 0 ? stored_edges / static_cast<double>(count) : 0;
    for (const glm::vec3& v : placed.position) {
        const glm::dvec3 p(v), frame = glm::abs(p), world = glm::abs(origin + p);
        in_frame = std::max({in_frame, frame.x, frame.y, frame.z});
        in_world = std::max({in_world, world.x, world.y, world.z});
    }
    const auto percent = [](double share) {
        return std::to_string(static_cast<int>(std::min(100 * share + 0.5, 1e6))) +
               " % of its mean edge length";
    };
    if (const double c = coarseness(largest(stored.position), stored_mean); c > kCoarse) {
        report.warn(placed.name,
                    "its POSITION values are so large that their float spacing is " + percent(c),
                    "centre the mesh on its own origin and move it by its node");
    } else if (const double f = coarseness(in_frame, mean); f > kCoarse) {
        report.warn(
            placed.name,
            "the scene is so large that the float spacing of its positions is " + percent(f),
            "bake distant parts as separate scenes");
    } else if (const double w = coarseness(in_world, mean); w > kCoarse) {
        report.warn(placed.name,
                    "it is so far from the world's origin that the float spacing of positions in "
                    "the baked file is " +
                        percent(w) + "; the light is computed before this rounding",
                    "bake it near the origin and move the baked object");
    }
}

}  // namespace opaline::formats::gltf
