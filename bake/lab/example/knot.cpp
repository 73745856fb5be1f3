#include "bake/lab/example/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace opaline::bake {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kTorusRadius = 2.0, kTubeRadius = 0.56;

glm::dvec3 spine(double t) {
    // A third of a turn between lobes; the offset puts one lobe on top and two below.
    const double angle = 2.0 * t + 0.5 * std::numbers::pi;
    const double radius = kTorusRadius + std::cos(3.0 * t);
    return {radius * std::cos(angle), radius * std::sin(angle), std::sin(3.0 * t)};
}

/// Parameters of `count` points at even distances along the closed spine.
std::vector<double> even_parameters(unsigned count) {
    const std::size_t steps = std::size_t{64} * count;
    std::vector<double> length(steps + 1, 0.0);
    const auto parameter = [&](double step) { return kTurn * step / static_cast<double>(steps); };
    for (std::size_t i = 1; i <= steps; ++i) {
        length[i] = length[i - 1] + glm::distance(spine(parameter(static_cast<double>(i))),
                                                  spine(parameter(static_cast<double>(i - 1))));
    }
    std::vector<double> parameters;
    std::size_t at = 0;
    for (unsigned i = 0; i < count; ++i) {
        const double wanted = length.back() * i / count;
        while (length[at + 1] <= wanted) {
            ++at;
        }
        const double part = (wanted - length[at]) / (length[at + 1] - length[at]);
        parameters.push_back(parameter(static_cast<double>(at) + part));
    }
    return parameters;
}

glm::dvec3 tangent(double t) {
    constexpr double kStep = 1e-5;
    return glm::normalize(spine(t + kStep) - spine(t - kStep));
}

/// `v` with its part along the unit vector `axis` removed, to unit length.
glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& axis) {
    return glm::normalize(v - glm::dot(v, axis) * axis);
}

}  // namespace

TriangleMesh make_knot(const KnotOptions& options) {
    const std::vector<double> parameters = even_parameters(options.along);
    std::vector<glm::dvec3> side(parameters.size() + 1);
    side[0] = across({0.0, 0.0, 1.0}, tangent(parameters[0]));
    for (std::size_t i = 1; i < side.size(); ++i) {
        side[i] = across(side[i - 1], tangent(parameters[i % parameters.size()]));
    }
    // Carried once around, the frame comes back turned; every ring takes its share of the rest.
    const glm::dvec3 axis = tangent(parameters[0]);
    const double twist = std::atan2(glm::dot(glm::cross(side[0], side.back()), axis),
                                    glm::dot(side[0], side.back()));

    TriangleMesh mesh;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        const glm::dvec3 u = side[i], v = glm::cross(tangent(parameters[i]), u);
        for (unsigned j = 0; j < options.around; ++j) {
            // Half a step from ring to ring makes the triangles equilateral. It needs an even
            // number of rings to close.
            const double share = static_cast<double>(i) / static_cast<double>(options.along);
            const double angle =
                kTurn * (j + 0.5 * static_cast<double>(i % 2)) / options.around - twist * share;
            const glm::dvec3 normal = std::cos(angle) * u + std::sin(angle) * v;
            mesh.position.push_back(spine(parameters[i]) + kTubeRadius * normal);
            mesh.normal.push_back(normal);
        }
    }
    const auto at = [&](unsigned i, unsigned j) {
        return i % options.along * options.around + j % options.around;
    };
    for (unsigned i = 0; i < options.along; ++i) {
        for (unsigned j = 0; j < options.around; ++j) {
            const std::uint32_t a = at(i, j), b = at(i, j + 1), c = at(i + 1, j + 1),
                                d = at(i + 1, j);
            if (i % 2 == 0) {
                mesh.triangles.push_back({a, b, d});
                mesh.triangles.push_back({b, c, d});
            } else {
                mesh.triangles.push_back({a, b, c});
                mesh.triangles.push_back({a, c, d});
            }
        }
    }
    double low = std::numeric_limits<double>::max(), high = std::numeric_limits<double>::lowest();
    for (const glm::dvec3& p : mesh.position) {
        low = std::min(low, p.y);
        high = std::max(high, p.y);
    }
    const double scale = options.height / (high - low);
    for (glm::dvec3& p : mesh.position) {
        p = scale * (p - glm::dvec3(0.0, low, 0.0)) - glm::dvec3(0.0, options.sink, 0.0);
    }
    return mesh;
}

}  // namespace opaline::bake
