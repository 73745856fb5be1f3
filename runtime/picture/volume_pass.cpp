#include "runtime/picture/volume_pass.h"

#include <limits>

#include "runtime/picture/sample_rays.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

MarchRay march_ray(const PictureRay& ray) {
    return {ray.origin, ray.direction, ray.begin, std::numeric_limits<double>::infinity()};
}

void compose(const MarchResult& seen, Rgb& color) {
    color = seen.radiance + seen.transmittance * color;
}

void draw_pixel(const VolumePass& pass, const Band& band, std::uint32_t x, std::uint32_t y,
                std::span<Rgb> color) {
    const std::uint32_t s = pass.supersampling;
    const double row = static_cast<double>(band.first_row / s) + y;
    const PictureRay centre = ray_through(pass.camera, pass.frame, x + 0.5, row + 0.5);
    const MarchRay march = march_ray(centre);
    const double end = volumes_end(pass.volumes, march);
    bool is_cut = false;
    for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t, std::uint32_t) {
        is_cut = is_cut || distance_along(centre, band.inverse_distance[sample]) < end;
    });
    if (!is_cut) {
        if (end <= march.begin) return;
        const MarchResult seen = march_volumes(pass.volumes, march);
        for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t, std::uint32_t) {
            compose(seen, color[sample]);
        });
        return;
    }
    for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t i, std::uint32_t j) {
        const PictureRay ray =
            ray_through(pass.camera, pass.frame, x + (i + 0.5) / s, row + (j + 0.5) / s);
        MarchRay to_sample = march_ray(ray);
        to_sample.end = distance_along(ray, band.inverse_distance[sample]);
        compose(march_volumes(pass.volumes, to_sample), color[sample]);
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
