#include "bake/lab/example/scene_parts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace opaline::bake {
namespace {

TriangleMesh make_icosahedron() {
    constexpr double g = std::numbers::phi;
    TriangleMesh mesh;
    mesh.normal = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (glm::dvec3& n : mesh.normal) {
        n = glm::normalize(n);
    }
    return mesh;
}

// Normals are all that counts here: on the unit sphere they are the positions.
void subdivide(TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle;
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
        const auto [at, added] =
            middle.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.normal.size()));
        if (added) {
            mesh.normal.push_back(glm::normalize(mesh.normal[a] + mesh.normal[b]));
        }
        return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
        const std::uint32_t ab = between(a, b), bc = between(b, c), ca = between(c, a);
        finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
}

constexpr std::size_t kSamplesPerSpan = 4;
constexpr int kNewtonSteps = 4;

}  // namespace

TriangleMesh turn_about_axis(std::span<const ProfilePoint> profile, unsigned around) {
    TriangleMesh mesh;
    for (const ProfilePoint& p : profile) {
        for (unsigned i = 0; i <= around; ++i) {
            const double turn = 2 * std::numbers::pi * (i % around) / around;
            const double s = std::sin(turn), c = std::cos(turn);
            mesh.position.push_back({p.radius * s, p.height, p.radius * c});
            mesh.normal.push_back(
                glm::normalize(glm::dvec3(p.normal.x * s, p.normal.y, p.normal.x * c)));
        }
    }
    const std::uint32_t row = around + 1;
    for (std::uint32_t j = 0; j + 1 < profile.size(); ++j) {
        // Two normals of one edge: nothing is between them.
        if (profile[j].radius == profile[j + 1].radius &&
            profile[j].height == profile[j + 1].height) {
            continue;
        }
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t v = j * row + i;
            if (profile[j].radius > 0) mesh.triangles.push_back({v, v + 1, v + row + 1});
            if (profile[j + 1].radius > 0) mesh.triangles.push_back({v, v + row + 1, v + row});
        }
    }
    return mesh;
}

TriangleMesh make_sphere(glm::dvec3 centre, double radius, unsigned levels) {
    TriangleMesh mesh = make_icosahedron();
    for (unsigned level = 0; level < levels; ++level) {
        subdivide(mesh);
    }
    for (const glm::dvec3& n : mesh.normal) {
        mesh.position.push_back(centre + radius * n);
    }
    return mesh;
}

TaperedCurve::TaperedCurve(const std::vector<glm::dvec4>& control) {
    assert(control.size() >= 2);
    // A phantom point mirrored through the end makes the spline start in that end.
    std::vector<glm::dvec4> p = {2.0 * control[0] - control[1]};
    p.insert(p.end(), control.begin(), control.end());
    p.push_back(2.0 * control.back() - control[control.size() - 2]);
    for (std::size_t i = 0; i + 3 < p.size(); ++i) {
        spans_.push_back({(p[i] + 4.0 * p[i + 1] + p[i + 2]) / 6.0, (p[i + 2] - p[i]) / 2.0,
                          (p[i] - 2.0 * p[i + 1] + p[i + 2]) / 2.0,
                          (p[i + 3] - 3.0 * p[i + 2] + 3.0 * p[i + 1] - p[i]) / 6.0});
    }
    for (std::size_t i = 0; i <= spans_.size() * kSamplesPerSpan; ++i) {
        samples_.emplace_back(evaluate(static_cast<double>(i) / double{kSamplesPerSpan}).value);
    }
    double largest = 0.0;
    for (const glm::dvec4& point : control) {
        largest = std::max(largest, point.w);
    }
    for (const glm::dvec3& point : samples_) {
        reach_ = std::max(reach_, chord_distance(point) + largest);
    }
}

double TaperedCurve::chord_distance(const glm::dvec3& p) const {
    const glm::dvec3 chord = samples_.back() - samples_.front();
    const glm::dvec3 offset = p - samples_.front();
    const double t = std::clamp(glm::dot(offset, chord) / glm::dot(chord, chord), 0.0, 1.0);
    return glm::length(offset - t * chord);
}

double TaperedCurve::distance_bound(const glm::dvec3& p) const {
    return chord_distance(p) - reach_;
}

TaperedCurve::Point TaperedCurve::evaluate(double t) const {
    const auto span = std::min(static_cast<std::size_t>(std::max(t, 0.0)), spans_.size() - 1);
    const double u = t - static_cast<double>(span);
    const auto& [a, b, c, d] = spans_[span];
    return {((d * u + c) * u + b) * u + a, (3.0 * u * d + 2.0 * c) * u + b, 6.0 * u * d + 2.0 * c};
}

TaperedCurve::Nearest TaperedCurve::nearest(const glm::dvec3& p) const {
    double best = std::numeric_limits<double>::max();
    std::size_t begin = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        const glm::dvec3 offset = samples_[i] - p;
        const double squared = glm::dot(offset, offset);
        if (squared < best) {
            best = squared;
            begin = i;
        }
    }
    const double end = static_cast<double>(spans_.size());
    double t = static_cast<double>(begin) / double{kSamplesPerSpan};
    Point point = evaluate(t);
    for (int step = 0; step < kNewtonSteps; ++step) {
        const glm::dvec3 offset = glm::dvec3(point.value) - p;
        const glm::dvec3 first(point.first);
        const double speed = glm::dot(first, first);
        // Past the centre of curvature the second derivative of the distance turns negative; the
        // floor keeps the step finite and downhill there.
        const double curvature =
            std::max(speed + glm::dot(offset, glm::dvec3(point.second)), 0.2 * speed);
        const double next = std::clamp(t - glm::dot(offset, first) / curvature, 0.0, end);
        const double moved = std::abs(next - t);
        t = next;
        point = evaluate(t);
        if (moved < 1e-6) break;
    }
    return {glm::dvec3(point.value), glm::normalize(glm::dvec3(point.first)), point.value.w,
            t / end};
}

double TaperedCurve::distance(const glm::dvec3& p) const {
    const Nearest spine = nearest(p);
    return glm::distance(p, spine.point) - spine.radius;
}

}  // namespace opaline::bake
