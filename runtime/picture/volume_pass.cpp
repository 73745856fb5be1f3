#include "runtime/picture/volume_pass.h"

#include <limits>

namespace opaline::runtime {
namespace {

using formats::Rgb;

// A ray through the point (x, y) of the picture [pixels], from the near plane on.
struct PictureRay {
    MarchRay march;
    double cosine = 1;  ///< of the angle to the view axis
};

PictureRay ray_through(const VolumePass& pass, double x, double y) {
    PictureRay ray;
    ray.march.origin = pass.camera.eye;
    ray.march.direction = view_ray(pass.camera, pass.frame, x, y);
    ray.cosine = -static_cast<double>(dot(ray.march.direction, pass.frame.backward));
    ray.march.begin = ray.cosine > 0 ? static_cast<double>(pass.camera.near_plane) / ray.cosine : 0;
    return ray;
}

// Distance along the ray to what a sample sees.
double distance_along(const PictureRay& ray, double inverse_distance) {
    return inverse_distance > 0 ? 1 / (inverse_distance * ray.cosine)
                                : std::numeric_limits<double>::infinity();
}

// Calls f(sample) for the samples of pixel (x, y), counted within the band.
template <class Function>
void for_samples(const Band& band, std::uint32_t s, std::uint32_t x, std::uint32_t y,
                 const Function& f) {
    for (std::uint32_t j = 0; j < s; ++j) {
        for (std::uint32_t i = 0; i < s; ++i) {
            f((std::size_t{y} * s + j) * band.columns + std::size_t{x} * s + i, i, j);
        }
    }
}

void compose(const MarchResult& seen, Rgb& color) {
    color = seen.radiance + seen.transmittance * color;
}

void draw_pixel(const VolumePass& pass, const Band& band, std::uint32_t x, std::uint32_t y,
                std::span<Rgb> color) {
    const std::uint32_t s = pass.supersampling;
    const double row = static_cast<double>(band.first_row / s) + y;
    const PictureRay centre = ray_through(pass, x + 0.5, row + 0.5);
    const double end = volumes_end(pass.volumes, centre.march);
    bool is_cut = false;
    for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t, std::uint32_t) {
        is_cut = is_cut || distance_along(centre, band.inverse_distance[sample]) < end;
    });
    if (!is_cut) {
        if (end <= centre.march.begin) return;
        const MarchResult seen = march_volumes(pass.volumes, centre.march);
        for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t, std::uint32_t) {
            compose(seen, color[sample]);
        });
        return;
    }
    for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t i, std::uint32_t j) {
        PictureRay ray = ray_through(pass, x + (i + 0.5) / s, row + (j + 0.5) / s);
        ray.march.end = distance_along(ray, band.inverse_distance[sample]);
        compose(march_volumes(pass.volumes, ray.march), color[sample]);
    });
}

}  // namespace

void draw_volumes(const VolumePass& pass, const Band& band, std::span<Rgb> color) {
    for (std::uint32_t y = 0; y < band.rows / pass.supersampling; ++y) {
        for (std::uint32_t x = 0; x < band.columns / pass.supersampling; ++x) {
            draw_pixel(pass, band, x, y, color);
        }
    }
}

}  // namespace opaline::runtime
