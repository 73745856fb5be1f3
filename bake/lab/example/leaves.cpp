#include "bake/lab/example/scene_parts.h"

#include <cmath>
#include <numbers>

namespace opaline::bake {
namespace {

// One leaf: a spine in a vertical plane through the foot, which rises and then bends over, and
// blades on both sides of it, folded upward.
struct Leaf {
    double azimuth = 0;         ///< [rad]
    double length = 90;         ///< [mm]
    double width = 20;          ///< half, [mm]
    double rise = 1, bend = 1;  ///< slope at the foot, and by how much it turns down [rad]
    double fold = 0.35;         ///< of each blade above the spine's flat [rad]

    // s in [0, 1] from foot to tip, t in [-1, 1] across.
    glm::dvec3 at(double s, double t) const {
        // The spine's slope changes evenly: its integral in closed form.
        const double end = rise - bend * s, rate = length / bend;
        const double out = rate * (std::sin(rise) - std::sin(end));
        const double up = rate * (std::cos(end) - std::cos(rise));
        // A stalk over the first fifth, then an oval that ends in a point.
        constexpr double kStalk = 0.2, kStalkWidth = 0.06;
        const double blade = std::max(0.0, (s - kStalk) / (1 - kStalk));
        const double oval = std::pow(blade, 0.7) * std::pow(1 - blade, 0.8) * 1.7;
        const double half = width * (kStalkWidth * (1 - s) + oval);
        const double ripple = 0.06 * std::sin(9 * std::numbers::pi * s) * t * t * half;
        const double side = half * t * std::cos(fold);
        const double lift = half * std::abs(t) * std::abs(t) * std::sin(fold) + ripple;
        const glm::dvec3 flat{out - lift * std::sin(end), up + lift * std::cos(end), side};
        const double c = std::cos(azimuth), s_azimuth = std::sin(azimuth);
        return {c * flat.x + s_azimuth * flat.z, flat.y, -s_azimuth * flat.x + c * flat.z};
    }

    glm::dvec3 normal(double s, double t) const {
        constexpr double kStep = 1e-4;
        return glm::normalize(
            glm::cross(at(s, t + kStep) - at(s, t - kStep), at(s + kStep, t) - at(s - kStep, t)));
    }
};

void append(const Leaf& leaf, const LeavesOptions& options, TriangleMesh& mesh) {
    const auto first = static_cast<std::uint32_t>(mesh.position.size());
    for (unsigned i = 0; i <= options.along; ++i) {
        for (unsigned j = 0; j <= options.across; ++j) {
            // The tip is a point: the last cells end just before it.
            constexpr double kTip = 0.995;
            const double s = kTip * i / options.along, t = 2.0 * j / options.across - 1;
            mesh.position.push_back(leaf.at(s, t));
            mesh.normal.push_back(leaf.normal(s, t));
        }
    }
    const std::uint32_t row = options.across + 1;
    for (std::uint32_t i = 0; i < options.along; ++i) {
        for (std::uint32_t j = 0; j < options.across; ++j) {
            const std::uint32_t v = first + i * row + j;
            mesh.triangles.push_back({v, v + 1, v + row});
            mesh.triangles.push_back({v + 1, v + row + 1, v + row});
        }
    }
}

}  // namespace

TriangleMesh make_leaves(const LeavesOptions& options) {
    TriangleMesh mesh;
    for (unsigned i = 0; i < options.leaves; ++i) {
        // Turned by the golden angle; inner leaves are younger: shorter and steeper.
        const double age = 1.0 - static_cast<double>(i) / options.leaves;
        Leaf leaf;
        leaf.azimuth = 2 * std::numbers::pi * (2 - std::numbers::phi) * i;
        leaf.length = 45 + 55 * age;
        leaf.width = 11 + 10 * age;
        leaf.rise = 1.45 - 0.45 * age;
        leaf.bend = 0.6 + 0.9 * age;
        append(leaf, options, mesh);
    }
    return mesh;
}

}  // namespace opaline::bake
