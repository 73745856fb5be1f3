#include "runtime/picture/check_camera.h"

#include <cmath>
#include <string>

#include "runtime/picture/picture.h"

namespace opaline::runtime {

formats::Status check_camera(const Camera& camera, std::uint32_t supersampling) {
    const auto refuse = [](const std::string& where, const std::string& fault,
                           const std::string& remedy) {
        return formats::make_error(formats::ErrorKind::usage, {}, where, fault, remedy);
    };
    if (camera.width < 1 || camera.height < 1 || camera.width > kMaxPictureSize ||
        camera.height > kMaxPictureSize) {
        return refuse("picture size",
                      "found " + std::to_string(camera.width) + "x" +
                          std::to_string(camera.height) + ", expected 1 to " +
                          std::to_string(kMaxPictureSize) + " pixels on each side",
                      "choose another size");
    }
    if (supersampling < 1 || supersampling > 8) {
        return refuse("supersampling",
                      "found " + std::to_string(supersampling) + ", expected 1 to 8",
                      "3 is a good choice");
    }
    if (!(camera.fov_y > 0.0f && camera.fov_y < 180.0f)) {
        return refuse("field of view",
                      "found " + std::to_string(camera.fov_y) +
                          " degrees, expected more than 0 and less than 180",
                      "40 is a good choice");
    }
    const formats::Vec3 sum = camera.eye + camera.target + camera.up;
    if (!std::isfinite(sum.x) || !std::isfinite(sum.y) || !std::isfinite(sum.z) ||
        !std::isfinite(camera.near_plane) || !(camera.near_plane > 0.0f)) {
        return refuse("camera", "a position is not finite or the near plane is not above 0",
                      "give finite coordinates");
    }
    return formats::ok_status();
}

}  // namespace opaline::runtime
