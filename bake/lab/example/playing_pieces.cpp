#include "bake/lab/example/scene_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "formats/image/srgb.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

// [mm] below the board, below its upper side, above it
constexpr double kSole = 0.4, kRim = 12, kStandTop = 17.9;

// Smooth through all points (Catmull-Rom), the normal on the outside of the way up.
void append_smooth(std::span<const glm::dvec2> points, unsigned steps,
                   std::vector<ProfilePoint>& profile) {
    const auto point = [&](std::ptrdiff_t i) {
        const auto last = static_cast<std::ptrdiff_t>(points.size()) - 1;
        return points[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, last))];
    };
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto at = static_cast<std::ptrdiff_t>(i);
        const glm::dvec2 a = point(at), b = point(at + 1);
        const glm::dvec2 from = 0.5 * (b - point(at - 1)), to = 0.5 * (point(at + 2) - a);
        const unsigned count = i + 2 == points.size() ? steps + 1 : steps;
        for (unsigned k = 0; k < count; ++k) {
            const double t = static_cast<double>(k) / steps, s = t * t, c = s * t;
            const glm::dvec2 p = (2 * c - 3 * s + 1) * a + (c - 2 * s + t) * from +
                                 (3 * s - 2 * c) * b + (c - s) * to;
            const glm::dvec2 way =
                (6 * s - 6 * t) * (a - b) + (3 * s - 4 * t + 1) * from + (3 * s - 2 * t) * to;
            profile.push_back({std::max(p.x, 0.0), p.y, {way.y, -way.x}});
        }
    }
}

// From the axis out along the floor: the lower side that closes a piece.
void append_sole(double radius, std::vector<ProfilePoint>& profile) {
    profile.push_back({0, -kSole, {0, -1}});
    profile.push_back({radius, -kSole, {0, -1}});
}

TriangleMesh moved(TriangleMesh mesh, double x, double z) {
    for (glm::dvec3& p : mesh.position)
        p += glm::dvec3(x, 0, z);
    return mesh;
}

// Growth rings of one board of wood, seen along it: darker where 1, lighter where -1.
double grain(double along, double across, double phase) {
    const double bend =
        0.35 * std::sin(2.2 * along + phase) + 0.1 * std::sin(5.3 * along + 3 * phase);
    const double rings = std::sin(2 * pi * 7 * (across + 0.12 * bend) + 5 * phase);
    const double pores = std::sin(2 * pi * 31 * (across + 0.05 * bend) + 0.9 * std::sin(9 * along));
    return 0.6 * rings * std::abs(rings) + 0.4 * pores;
}

}  // namespace

TriangleMesh make_pawn(double x, double z) {
    std::vector<ProfilePoint> profile;
    append_sole(12.6, profile);
    std::vector<glm::dvec2> points{{12.6, -kSole}, {13.4, 0.6}, {13.2, 3.2}, {10.6, 5.6},
                                   {7.4, 9.6},     {5.4, 15},   {4.7, 21},   {5.2, 23.6},
                                   {7.7, 24.8},    {7.7, 26.2}, {5.3, 27.4}};
    constexpr double kHead = 7.2;  // radius, about a point 33.6 above the floor
    for (int degrees = -42; degrees <= 90; degrees += 12) {
        const double turn = degrees * pi / 180;
        points.emplace_back(kHead * std::cos(turn), 33.6 + kHead * std::sin(turn));
    }
    points.back().x = 0;
    append_smooth(points, 3, profile);
    profile.back() = {0, profile.back().height, {0, 1}};
    return moved(turn_about_axis(profile, 48), x, z);
}

TriangleMesh make_draughtsman(double x, double z) {
    std::vector<ProfilePoint> profile;
    append_sole(10, profile);
    std::vector<glm::dvec2> rim;
    for (int degrees = -90; degrees <= 90; degrees += 15) {
        const double turn = degrees * pi / 180;
        rim.emplace_back(10 + (4 + 0.5 * kSole) * std::cos(turn),
                         4 - 0.5 * kSole + (4 + 0.5 * kSole) * std::sin(turn));
    }
    rim.front() = {10, -kSole};  // the same bits as the sole: nothing is between them
    append_smooth(rim, 2, profile);
    // A shallow bowl.
    for (const double radius : {8.2, 6.0, 4.0, 2.0, 0.0}) {
        profile.push_back(
            {radius, 8 - 1.2 * (1 - radius * radius / 100), {-2.4 * radius / 100, 1}});
    }
    return moved(turn_about_axis(profile, 48), x, z);
}

TriangleMesh make_stand(double x, double z) {
    std::vector<ProfilePoint> profile;
    append_sole(9, profile);
    const std::vector<glm::dvec2> points{{9, -kSole}, {9.8, 0.6}, {9.4, 2.2}, {5.4, 4.6},
                                         {2.8, 8.6},  {2.2, 13},  {2.9, 16},  {4.6, kStandTop}};
    append_smooth(points, 3, profile);
    profile.push_back({4.6, kStandTop, {0, 1}});
    profile.push_back({0, kStandTop, {0, 1}});
    return moved(turn_about_axis(profile, 48), x, z);
}

TriangleMesh make_squashed_ball(double x, double z) {
    constexpr double kGap = 0.1;  // so that no light has to pass where they touch
    const glm::dvec3 radii(13, 9, 13);
    TriangleMesh ball = make_sphere(glm::dvec3(0), 1, 4);
    for (std::size_t i = 0; i < ball.position.size(); ++i) {
        ball.normal[i] = glm::normalize(ball.position[i] / radii);
        ball.position[i] = ball.position[i] * radii + glm::dvec3(x, kStandTop + radii.y + kGap, z);
    }
    return ball;
}

TriangleMesh make_board() {
    TriangleMesh board;
    constexpr double s = kBoardSide, h = s / 2;
    append_grid(board, 64, 64, {-h, 0, h}, {s, 0, 0}, {0, 0, -s});
    append_grid(board, 64, 3, {-h, -kRim, h}, {s, 0, 0}, {0, kRim, 0});
    append_grid(board, 64, 3, {h, -kRim, h}, {0, 0, -s}, {0, kRim, 0});
    append_grid(board, 64, 3, {h, -kRim, -h}, {-s, 0, 0}, {0, kRim, 0});
    append_grid(board, 64, 3, {-h, -kRim, -h}, {0, 0, s}, {0, kRim, 0});
    return board;
}

std::vector<glm::dvec2> board_coordinates(const TriangleMesh& board) {
    std::vector<glm::dvec2> coordinates;
    coordinates.reserve(board.position.size());
    for (const glm::dvec3& p : board.position) {
        // The rim goes on with the picture's outermost millimetres.
        const double inward = 1 + p.y / kBoardSide;
        coordinates.emplace_back(0.5 + inward * p.x / kBoardSide, 0.5 + inward * p.z / kBoardSide);
    }
    return coordinates;
}

formats::Image8 paint_board() {
    constexpr std::uint32_t kPixels = 1024;
    constexpr formats::Rgb kLight{0.56f, 0.37f, 0.19f}, kDark{0.125f, 0.052f, 0.022f},
        kBorder{0.075f, 0.028f, 0.014f}, kInlay{0.62f, 0.47f, 0.27f};
    formats::Image picture{kPixels, kPixels, {}};
    picture.pixel.reserve(std::size_t{kPixels} * kPixels);
    for (std::uint32_t row = 0; row < kPixels; ++row) {
        for (std::uint32_t column = 0; column < kPixels; ++column) {
            const auto place = [](std::uint32_t i) {
                return ((i + 0.5) / kPixels - 0.5) * kBoardSide / kSquareSide;  // in squares
            };
            const double x = place(column), y = place(row);
            const double from_middle = std::max(std::abs(x), std::abs(y));
            const double i = std::floor(x), j = std::floor(y);
            const bool is_light = std::fmod(i + j + 16, 2) == 0;
            formats::Rgb color = kBorder;
            double rings = grain(0.4 * x, 1.6 * y, 0.7);
            if (from_middle < 4) {
                color = is_light ? kLight : kDark;
                rings = grain(x - i, is_light ? y - j : x - i + 0.3 * (y - j), 1.7 * i + 2.9 * j);
            } else if (from_middle < 4.05) {
                color = kInlay;
            }
            const auto shade = static_cast<float>(1 - 0.22 * rings);
            picture.pixel.push_back(shade * color);
        }
    }
    return formats::to_srgb(picture);
}

}  // namespace opaline::bake
