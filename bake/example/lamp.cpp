#include "bake/example/scene_parts.h"

#include <array>
#include <vector>

#include "bake/example/turned.h"

namespace opaline::bake {

TriangleMesh make_shade(const ShadeOptions& options) {
    const glm::dvec2 normal(options.high - options.low, options.low_radius - options.high_radius);
    std::vector<ProfilePoint> profile;
    for (unsigned j = 0; j <= options.along; ++j) {
        const double t = static_cast<double>(j) / options.along;
        profile.push_back({options.low_radius + t * (options.high_radius - options.low_radius),
                           options.low + t * (options.high - options.low), normal});
    }
    return turn_about_axis(profile, options.around);
}

TriangleMesh make_thick_shade(const ShadeOptions& options, double thickness) {
    const glm::dvec2 normal(options.high - options.low, options.low_radius - options.high_radius);
    std::vector<ProfilePoint> profile;
    profile.reserve(2 * std::size_t{options.along} + 7);
    const auto add = [&](double t, bool is_inner, const glm::dvec2& facing) {
        profile.push_back({options.low_radius + t * (options.high_radius - options.low_radius) -
                               (is_inner ? thickness : 0),
                           options.low + t * (options.high - options.low), facing});
    };
    for (unsigned j = 0; j <= options.along; ++j) {
        add(static_cast<double>(j) / options.along, false, normal);
    }
    add(1, false, {0, 1});
    add(1, true, {0, 1});
    for (unsigned j = 0; j <= options.along; ++j) {
        add(1 - static_cast<double>(j) / options.along, true, -normal);
    }
    add(0, true, {0, -1});
    add(0, false, {0, -1});
    return turn_about_axis(profile, options.around);
}

TriangleMesh make_lamp_foot() {
    // Edges have a point for each of their two normals.
    constexpr std::array<ProfilePoint, 8> kProfile{{{55, -0.4, {1, 0}},
                                                    {55, 10, {1, 0}},
                                                    {55, 10, {0, 1}},
                                                    {6, 14, {0, 1}},
                                                    {6, 14, {1, 0}},
                                                    {6, 80, {1, 0}},
                                                    {6, 165, {1, 0}},
                                                    {0, 165, {1, 1}}}};
    return turn_about_axis(kProfile, 48);
}

TriangleMesh make_wall() {
    TriangleMesh mesh;
    constexpr unsigned kAcross = 48, kUp = 28;
    constexpr double kCell = 17;
    for (unsigned j = 0; j <= kUp; ++j) {
        for (unsigned i = 0; i <= kAcross; ++i) {
            mesh.position.push_back({kCell * (i - kAcross / 2.0), kCell * j - 0.4, -230});
            mesh.normal.push_back({0, 0, 1});
        }
    }
    for (std::uint32_t j = 0; j < kUp; ++j) {
        for (std::uint32_t i = 0; i < kAcross; ++i) {
            const std::uint32_t v = j * (kAcross + 1) + i;
            mesh.triangles.push_back({v, v + 1, v + kAcross + 2});
            mesh.triangles.push_back({v, v + kAcross + 2, v + kAcross + 1});
        }
    }
    return mesh;
}

TriangleMesh make_panel(const PanelOptions& options) {
    TriangleMesh mesh;
    const unsigned n = options.cells;
    for (unsigned j = 0; j <= n; ++j) {
        for (unsigned i = 0; i <= n; ++i) {
            mesh.position.push_back(
                {options.x, options.height * j / n,
                 options.z + options.width * (static_cast<double>(i) / n - 0.5)});
            mesh.normal.push_back({-1, 0, 0});
        }
    }
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t v = j * (n + 1) + i;
            mesh.triangles.push_back({v, v + 1, v + n + 2});
            mesh.triangles.push_back({v, v + n + 2, v + n + 1});
        }
    }
    return mesh;
}

}  // namespace opaline::bake
