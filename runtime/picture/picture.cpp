#include "runtime/picture/picture.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <string>

namespace opaline::runtime {

formats::Result<Picture> make_picture(std::uint32_t width, std::uint32_t height) {
    Picture picture{width, height, {}};
    try {
        picture.pixel.resize(std::size_t{width} * height);
    } catch (const std::bad_alloc&) {
        return formats::make_error(
            formats::ErrorKind::resource, {}, "picture",
            "no memory for " + std::to_string(width) + "x" + std::to_string(height) + " pixels",
            "choose a smaller size");
    }
    return picture;
}

std::uint32_t rows_of_band(const SampleGrid& grid, std::uint32_t supersampling) {
    constexpr std::uint32_t kMostPixels = 16, kMostSamples = 1u << 20;
    return std::clamp(kMostSamples / (grid.columns * supersampling), 1u, kMostPixels) *
           supersampling;
}

void resolve_samples(const Samples& samples, std::uint32_t supersampling, Picture& picture) {
    const std::uint32_t s = supersampling;
    const Band& band = samples.band;
    const float share = 1.0f / static_cast<float>(s * s);
    for (std::uint32_t y = 0; y < band.rows / s; ++y) {
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            formats::Rgb sum;
            for (std::uint32_t j = 0; j < s; ++j) {
                for (std::uint32_t i = 0; i < s; ++i) {
                    const std::size_t row = std::size_t{y} * s + j;
                    sum = sum + samples.color[row * band.columns + x * s + i];
                }
            }
            picture.pixel[(std::size_t{band.first_row / s} + y) * picture.width + x] = share * sum;
        }
    }
}

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

std::vector<PicturePass> list_passes(bool background, bool volumes, bool layers) {
    std::vector<PicturePass> passes{PicturePass::surfaces};
    if (background) passes.push_back(PicturePass::background);
    if (layers) passes.push_back(PicturePass::layers);
    if (volumes) passes.push_back(PicturePass::volumes);
    return passes;
}

}  // namespace opaline::runtime
