#include "tests/bake/path_differentials/camera_start.h"

#include "bake/path_differentials/disk_map.h"

namespace opaline::bake {

CameraStart start_at_pinhole(const PinholeCamera& camera, double x, double y) {
    return start_at_lens({camera, glm::dvec3(0), glm::dvec3(0)}, x, y, 0.5, 0.5);
}

CameraStart start_at_lens(const LensCamera& camera, double x, double y, double u, double v) {
    const DiskPoint disk = map_to_disk(DiskMap::concentric, u, v);
    const glm::dvec2 e = disk.outward;
    const auto on_lens = [&](const glm::dvec2& p) {
        return p.x * camera.lens_x + p.y * camera.lens_y;
    };
    const auto column = [&](const DiskColumn& by) {
        return on_lens(by.radial * e + by.tangential * glm::dvec2(-e.y, e.x));
    };
    const glm::dvec3 offset = on_lens(disk.radius * e);
    const PinholeCamera& eye = camera.pinhole;
    const glm::dvec3 h = eye.view + x * eye.right + y * eye.up - offset;
    const double length = glm::length(h);
    CameraStart start{.P = eye.eye + offset, .D = h / length};
    const auto turned = [&](const glm::dvec3& dh) {
        return (dh - start.D * glm::dot(start.D, dh)) / length;
    };
    start.dD_dx = turned(eye.right);
    start.dD_dy = turned(eye.up);
    start.dP_du = column(disk.du);
    start.dP_dv = column(disk.dv);
    start.dD_du = turned(-start.dP_du);
    start.dD_dv = turned(-start.dP_dv);
    return start;
}

}  // namespace opaline::bake
