#include "runtime/picture/volume_pass.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "runtime/clouds/see_layer.h"
#include "runtime/picture/sample_rays.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

// Up to a surface at `end`, or to the ground.
MarchRay march_ray(const VolumePass& pass, const PictureRay& ray,
                   double end = std::numeric_limits<double>::infinity()) {
    if (pass.layer != nullptr) {
        end = opaque_distance(end, ground_distance(*pass.layer, ray.origin, ray.direction));
    }
    return {ray.origin, ray.direction, ray.begin, end};
}

void compose(const MarchResult& seen, Rgb& color) {
    color = seen.radiance + seen.transmittance * color;
}

// The volumes on both sides of a sheet.
struct TwoParts {
    MarchResult front, behind;
};

TwoParts march_around(const LitVolumes& volumes, const MarchRay& ray, float distance) {
    MarchRay front = ray, behind = ray;
    front.end = behind.begin = std::clamp(static_cast<double>(distance), ray.begin, ray.end);
    return {march_volumes(volumes, front), march_volumes(volumes, behind)};
}

// Rounding must not make the rest negative.
Rgb without(Rgb color, Rgb part) {
    return {std::max(color.r - part.r, 0.0f), std::max(color.g - part.g, 0.0f),
            std::max(color.b - part.b, 0.0f)};
}

void compose(const TwoParts& seen, const LayerSheet& sheet, Rgb& color) {
    const Rgb behind = sheet.transmittance * seen.behind.radiance +
                       seen.behind.transmittance * without(color, sheet.radiance);
    color = seen.front.radiance + seen.front.transmittance * (sheet.radiance + behind);
}

// Whether one march does for all of them, on a ray that meets volumes from begin to end.
bool agree(std::span<const LayerSheet> sheets, const MarchSpan& span) {
    double low = span.end, high = span.begin;
    for (const LayerSheet& sheet : sheets) {
        if (!sheet.is_met()) continue;
        const double at = std::clamp(static_cast<double>(sheet.distance), span.begin, span.end);
        low = std::min(low, at);
        high = std::max(high, at);
    }
    return high - low <= kSheetTolerance * (span.end - span.begin);
}

std::vector<LayerSheet> sheets_of_pixel(const VolumePass& pass, const Band& band, std::uint32_t x,
                                        std::uint32_t y) {
    std::vector<LayerSheet> sheets;
    for_samples(band, pass.supersampling, x, y,
                [&](std::size_t sample, std::uint32_t, std::uint32_t) {
                    sheets.push_back(pass.sheets[sample]);
                });
    return sheets;
}

void draw_samples(const VolumePass& pass, const Band& band, std::uint32_t x, std::uint32_t y,
                  std::span<Rgb> color) {
    const std::uint32_t s = pass.supersampling;
    const double row = first_pixel_row(band, s) + y;
    for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t i, std::uint32_t j) {
        const PictureRay ray =
            ray_through(pass.camera, pass.frame, x + (i + 0.5) / s, row + (j + 0.5) / s);
        const MarchRay to_sample =
            march_ray(pass, ray, distance_along(ray, band.inverse_distance[sample]));
        if (pass.layer == nullptr) {
            compose(march_volumes(pass.volumes, to_sample), color[sample]);
            return;
        }
        const LayerSheet& sheet = pass.sheets[sample];
        compose(march_around(pass.volumes, to_sample, sheet.distance), sheet, color[sample]);
    });
}

void draw_pixel(const VolumePass& pass, const Band& band, std::uint32_t x, std::uint32_t y,
                std::span<Rgb> color) {
    const std::uint32_t s = pass.supersampling;
    const double row = first_pixel_row(band, s) + y;
    const PictureRay centre = ray_through(pass.camera, pass.frame, x + 0.5, row + 0.5);
    const MarchRay march = march_ray(pass, centre);
    const MarchSpan span = volumes_span(pass.volumes, march);
    bool is_cut = false;
    for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t, std::uint32_t) {
        is_cut = is_cut || distance_along(centre, band.inverse_distance[sample]) < span.end;
    });
    if (is_cut) return draw_samples(pass, band, x, y, color);
    if (span.end <= march.begin) return;
    if (pass.layer == nullptr) {
        const MarchResult seen = march_volumes(pass.volumes, march);
        for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t, std::uint32_t) {
            compose(seen, color[sample]);
        });
        return;
    }
    const std::vector<LayerSheet> sheets = sheets_of_pixel(pass, band, x, y);
    if (!agree(sheets, span)) return draw_samples(pass, band, x, y, color);
    const TwoParts seen = march_around(pass.volumes, march, mean_sheet(sheets).distance);
    for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t, std::uint32_t) {
        compose(seen, pass.sheets[sample], color[sample]);
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
