#include "bake/path_images/even_furnace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/base/ordered_parallel.h"

namespace opaline::bake {

double furnace_factor(const ScatteringSpace& space, const ViewRay& ray, const MediumBand& band,
                      std::size_t number, const SkyView& sky) {
    const ViewBand& steps = ray.band[number];
    const RayLight light = gather_scattered(
        space, ray, sky,
        {.band = band, .steps = steps, .shadows = Shadows::of_volumes, .suns = false});
    const double missing = -std::expm1(-steps.tau) - light.once.x;
    return light.often.x > 0 ? std::clamp(missing / light.often.x, kLeastFactor, kMostFactor) : 1;
}

double FurnaceGrid::at(double x, double y, std::size_t band) const {
    const auto place = [](double pixel, std::uint32_t count) {
        return std::clamp(pixel / kPixels, 0.0, static_cast<double>(count - 1));
    };
    const double u = place(x, columns), v = place(y, rows);
    double sum = 0, weights = 0;
    for (unsigned c = 0; c < 4; ++c) {
        const auto i = std::min(static_cast<std::uint32_t>(u) + (c & 1), columns - 1);
        const auto j = std::min(static_cast<std::uint32_t>(v) + (c >> 1), rows - 1);
        const double weight =
            std::max(0.0, 1 - std::abs(u - i)) * std::max(0.0, 1 - std::abs(v - j));
        const double value = factor[(std::size_t{j} * columns + i) * bands + band];
        if (value > 0) {
            sum += weight * value;
            weights += weight;
        }
    }
    return weights > 0 ? sum / weights : 1;
}

FurnaceGrid make_furnace_grid(const ScatteringSpace& space, const runtime::Camera& camera,
                              glm::vec3 eye, const Context& context) {
    FurnaceGrid grid;
    grid.columns = (camera.width + FurnaceGrid::kPixels - 1) / FurnaceGrid::kPixels + 1;
    grid.rows = (camera.height + FurnaceGrid::kPixels - 1) / FurnaceGrid::kPixels + 1;
    grid.bands = static_cast<std::uint32_t>(space.bands.size());
    std::vector<MediumBand> bands;
    for (const MediumBand& band : space.bands) {
        bands.push_back(without_absorption(band));
    }
    const std::size_t corners = std::size_t{grid.columns} * grid.rows;
    grid.factor.resize(corners * grid.bands);
    const ImageSky even = make_even_sky();
    const runtime::CameraFrame frame = runtime::camera_frame(camera);
    for_each_block_in_order(
        corners, 8, context,
        [&](Range range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const std::size_t column = i % grid.columns, row = i / grid.columns;
                const auto d = runtime::view_ray(camera, frame,
                                                 static_cast<double>(column * FurnaceGrid::kPixels),
                                                 static_cast<double>(row * FurnaceGrid::kPixels));
                const ViewRay ray = march_view_ray(space.volumes, bands, eye, {d.x, d.y, d.z},
                                                   std::numeric_limits<float>::infinity());
                if (ray.is_empty()) {
                    continue;
                }
                const SkyView sky =
                    view_sky(even, space.phase.density, space.phase.ray, glm::dvec3(ray.direction));
                for (std::size_t k = 0; k < bands.size(); ++k) {
                    grid.factor[i * grid.bands + k] = furnace_factor(space, ray, bands[k], k, sky);
                }
            }
            return range.end;
        },
        [&](Range, std::size_t done) {
            if (context.on_progress) {
                context.on_progress({"white furnace", done, corners});
            }
        });
    return grid;
}

}  // namespace opaline::bake
