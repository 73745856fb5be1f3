#include "bake/physics/path_differentials/disk_map.h"

#include <cmath>
#include <numbers>

namespace opaline::bake {

// The larger coordinate is the radius, with its sign; the other one over it turns by 45 degrees at
// most.
DiskPoint map_to_disk(double u, double v) {
    constexpr double kPi = std::numbers::pi;
    const double a = 2 * u - 1, b = 2 * v - 1;
    const bool by_a = std::abs(a) > std::abs(b) || (a == 0 && b == 0);
    const double r = by_a ? a : b, other = by_a ? b : a;
    const double k = r != 0 ? other / r : 0, sign = r < 0 ? -1 : 1;
    const double phi = by_a ? kPi / 4 * k : kPi / 2 - kPi / 4 * k;
    // Of b alone the azimuth falls as a grows: the turn has the other sign.
    const double turn = by_a ? 1 : -1;
    const DiskColumn along{4 * r, 2 * sign, -turn * kPi / 2 * k * sign};
    const DiskColumn across{0, 0, turn * kPi / 2 * sign};
    return {r * r, std::abs(r), sign * glm::dvec2(std::cos(phi), std::sin(phi)),
            by_a ? along : across, by_a ? across : along};
}

}  // namespace opaline::bake
