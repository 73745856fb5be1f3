#include "bake/physics/path_differentials/visible_normal.h"

#include <cmath>

#include "bake/physics/path_differentials/lobe.h"

namespace opaline::bake {
namespace {

/// d(h / |h|) for a change dh.
glm::dvec3 turned_by(const glm::dvec3& direction, double length, const glm::dvec3& dh) {
    return (dh - direction * glm::dot(direction, dh)) / length;
}

}  // namespace

VisibleNormal sample_visible_normal(const glm::dvec3& w_i, const MicrofacetWidths& widths, double u,
                                    double v) {
    const glm::dvec3 widen(widths.x, widths.y, 1);
    const glm::dvec3 stretched = widen * w_i;
    const double length = glm::length(stretched);
    const glm::dvec3 w = stretched / length;
    const double height = 1 + w.z;
    const LobeDirection cap = sample_lobe({Lobe::Kind::cap, height}, u, v);
    const DiskPoint disk = map_to_disk(u, v);
    const glm::dvec3 half = widen * (cap.D + w);  // not unit
    const double half_length = glm::length(half);
    VisibleNormal normal{.m = half / half_length};
    const auto column = [&](const glm::dvec3& dh) {
        return turned_by(normal.m, half_length, widen * dh);
    };
    normal.dm_du = column(cap.dD_du);
    normal.dm_dv = column(cap.dD_dv);
    // At fixed (u, v) the cap moves with its height: dc_z = -q dK, and its sine s = sqrt(K q
    // (2 - K q)) by (1 - K q) q dK / s, along the point of the disk.
    const double stretch = std::sqrt(height * (2 - height * disk.q));
    const glm::dvec3 dcap((1 - height * disk.q) * disk.radius / stretch * disk.outward, -disk.q);
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 dwi(0);
        dwi[axis] = widen[axis];
        const glm::dvec3 dw = turned_by(w, length, dwi);
        normal.dm_dwi[axis] = column(dw.z * dcap + dw);
    }
    return normal;
}

}  // namespace opaline::bake
