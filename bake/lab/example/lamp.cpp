#include "bake/lab/example/scene_parts.h"

#include <array>
#include <vector>

namespace opaline::bake {

namespace {

// Of a cone by its profile's height: t = 0 at its low rim, 1 at its high one.
ProfilePoint shade_point(const ShadeOptions& options, double t, double inward,
                         const glm::dvec2& facing) {
    return {options.low_radius + t * (options.high_radius - options.low_radius) - inward,
            options.low + t * (options.high - options.low), facing};
}

// The outer side, from its low rim to its high one.
std::vector<ProfilePoint> outer_profile(const ShadeOptions& options) {
    const glm::dvec2 normal(options.high - options.low, options.low_radius - options.high_radius);
    std::vector<ProfilePoint> profile;
    for (unsigned j = 0; j <= options.along; ++j) {
        const double t = static_cast<double>(j) / options.along;
        profile.push_back(shade_point(options, t, 0, normal));
    }
    return profile;
}

}  // namespace

TriangleMesh make_shade(const ShadeOptions& options) {
    return turn_about_axis(outer_profile(options), options.around);
}

TriangleMesh make_thick_shade(const ShadeOptions& options, double thickness) {
    std::vector<ProfilePoint> profile = outer_profile(options);
    const glm::dvec2 inner = -profile.front().normal;
    const auto add = [&](double t, double inward, const glm::dvec2& facing) {
        profile.push_back(shade_point(options, t, inward, facing));
    };
    add(1, 0, {0, 1});
    add(1, thickness, {0, 1});
    for (unsigned j = 0; j <= options.along; ++j) {
        add(1 - static_cast<double>(j) / options.along, thickness, inner);
    }
    add(0, thickness, {0, -1});
    add(0, 0, {0, -1});
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
    append_grid(mesh, 48, 28, {-408, -0.4, -230}, {816, 0, 0}, {0, 476, 0});
    return mesh;
}

TriangleMesh make_panel(const PanelOptions& options) {
    TriangleMesh mesh;
    append_grid(mesh, options.cells, options.cells, {options.x, 0, options.z - options.width / 2},
                {0, 0, options.width}, {0, options.height, 0});
    return mesh;
}

}  // namespace opaline::bake
