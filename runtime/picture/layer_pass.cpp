#include "runtime/picture/layer_pass.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/picture/sample_rays.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

LayerRay layer_ray(const LayerPass& pass, const PictureRay& ray, double end) {
    return {ray.origin, ray.direction, ray.begin, end,
            static_cast<float>(2 * pass.frame.tan_half_y / pass.camera.height)};
}

Rgb bounded(Rgb color) {
    const auto bound = [](float value) { return value > 0 ? std::min(value, 1e35f) : 0.0f; };
    return {bound(color.r), bound(color.g), bound(color.b)};
}

SeenRay see_sample(const LayerPass& pass, double x, double y, double inverse_distance, Rgb behind) {
    const PictureRay ray = ray_through(pass.camera, pass.frame, x, y);
    SeenRay seen =
        see_along(pass.scene, layer_ray(pass, ray, distance_along(ray, inverse_distance)),
                  inverse_distance > 0 ? &behind : nullptr);
    seen.radiance = bounded(seen.radiance);
    seen.sheet.radiance = bounded(seen.sheet.radiance);
    return seen;
}

// Whether a sun's disc may touch the pixel whose centre is (x, y).
bool is_near_sun(const LayerPass& pass, double x, double y) {
    const formats::Vec3 direction = view_ray(pass.camera, pass.frame, x, y);
    const auto pixel = static_cast<float>(2 * pass.frame.tan_half_y / pass.camera.height);
    return std::ranges::any_of(pass.scene.light.sky.suns, [&](const LayerSun& sun) {
        return length(sun.direction - direction) < 1.1f * sun.angular_radius + 2 * pixel;
    });
}

bool agree(const std::array<SeenRay, 4>& corner) {
    const auto differs = [&](float Rgb::*band) {
        float low = corner[0].radiance.*band, high = low;
        for (const SeenRay& c : corner) {
            low = std::min(low, c.radiance.*band);
            high = std::max(high, c.radiance.*band);
        }
        return high - low > kCornerTolerance * high;
    };
    return !differs(&Rgb::r) && !differs(&Rgb::g) && !differs(&Rgb::b);
}

// What the corners of pixels along a line between rows see where there are no surfaces, each when
// it is first asked for.
class CornerRow {
  public:
    CornerRow(const LayerPass& pass, std::size_t count) : pass_(&pass), value_(count) {}

    void move_to(double y) {
        y_ = y;
        std::ranges::fill(value_, std::nullopt);
    }
    const SeenRay& at(std::size_t x) {
        if (!value_[x]) value_[x] = see_sample(*pass_, static_cast<double>(x), y_, 0, {});
        return *value_[x];
    }

  private:
    const LayerPass* pass_;
    std::vector<std::optional<SeenRay>> value_;
    double y_ = 0;
};

// The mean of a pixel's corners, if they agree.
std::optional<SeenRay> smooth_pixel(const LayerPass& pass, std::uint32_t x, double row,
                                    CornerRow& above, CornerRow& below) {
    if (is_near_sun(pass, x + 0.5, row + 0.5)) return std::nullopt;
    const std::array<SeenRay, 4> corner{above.at(x), above.at(x + 1), below.at(x), below.at(x + 1)};
    if (!agree(corner)) return std::nullopt;
    const Rgb color =
        0.25f * (corner[0].radiance + corner[1].radiance + corner[2].radiance + corner[3].radiance);
    return SeenRay{color, mean_sheet(std::array{corner[0].sheet, corner[1].sheet, corner[2].sheet,
                                                corner[3].sheet})};
}

void draw_layer_pixel(const LayerPass& pass, const Band& band, std::uint32_t x, std::uint32_t y,
                      CornerRow& above, CornerRow& below, const LayerSamples& samples) {
    const auto set = [&](std::size_t sample, const SeenRay& seen) {
        samples.color[sample] = seen.radiance;
        if (!samples.sheet.empty()) samples.sheet[sample] = seen.sheet;
    };
    const std::uint32_t s = pass.supersampling;
    const double row = first_pixel_row(band, s) + y;
    bool sees_surface = false;
    for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t, std::uint32_t) {
        sees_surface = sees_surface || band.inverse_distance[sample] > 0;
    });
    if (!sees_surface) {
        if (const auto smooth = smooth_pixel(pass, x, row, above, below)) {
            for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t, std::uint32_t) {
                set(sample, *smooth);
            });
            return;
        }
    }
    for_samples(band, s, x, y, [&](std::size_t sample, std::uint32_t i, std::uint32_t j) {
        set(sample, see_sample(pass, x + (i + 0.5) / s, row + (j + 0.5) / s,
                               band.inverse_distance[sample], samples.color[sample]));
    });
}

}  // namespace

void draw_layers(const LayerPass& pass, const Band& band, const LayerSamples& samples) {
    const std::uint32_t s = pass.supersampling;
    CornerRow above(pass, band.columns / s + 1), below(pass, band.columns / s + 1);
    const double first = first_pixel_row(band, s);
    above.move_to(first);
    for (std::uint32_t y = 0; y < band.rows / s; ++y) {
        below.move_to(first + y + 1);
        for (std::uint32_t x = 0; x < band.columns / s; ++x) {
            draw_layer_pixel(pass, band, x, y, above, below, samples);
        }
        std::swap(above, below);
    }
}

}  // namespace opaline::runtime
