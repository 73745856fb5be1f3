#pragma once

#include <vector>

#include "runtime/picture/camera.h"
#include "tests/runtime/embed_gl/host/host_picture.h"

namespace opaline::test {

/// From the eye through the middle of each pixel.
inline std::vector<HostRay> camera_rays(const runtime::Camera& camera) {
    const runtime::CameraFrame frame = runtime::camera_frame(camera);
    std::vector<HostRay> rays;
    for (std::uint32_t i = 0; i < camera.width * camera.height; ++i) {
        const formats::Vec3 d =
            runtime::view_ray(camera, frame, i % camera.width + 0.5, i / camera.width + 0.5);
        rays.push_back({{0, 0, 0}, camera.near_plane, {d.x, d.y, d.z}, 1e30f});
    }
    return rays;
}

}  // namespace opaline::test
