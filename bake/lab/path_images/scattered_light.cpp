#include "bake/lab/path_images/scattered_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/base/ordered_parallel.h"
#include "bake/physics/path_integral/least_attenuation.h"
#include "bake/physics/path_integral/quasi_path.h"

namespace opaline::bake {
namespace {

constexpr int kSourcePoints = 8;  // along a ray, in equal shares of what is scattered and seen
constexpr double kClear = 1e-3;   // optical depth that ends a path on its way to the light

// Order 1.
glm::dvec3 gather_once(const ScatteringSpace& space, const ViewRay& ray, const SkyView& sky,
                       const ScatterOptions& options) {
    const std::vector<ImageSun>& suns = space.lights.suns;
    const BandMedium medium{space.volumes, options.band};
    std::vector<double> from_sun(options.suns ? suns.size() : 0);
    std::array<double, ImageSky::kCellCount + 1> from_part{};
    // The paper's boundary holds light of the sky that is scattered once.
    const bool has_cells =
        !space.curvature && std::any_of(sky.part.begin(), sky.part.end(),
                                        [](const SkyPart& part) { return !part.is_dark; });
    for (std::size_t i = 0; i < ray.position.size(); ++i) {
        const ViewStep& step = options.steps.step[i];
        const glm::dvec3 x(ray.position[i]);
        for (std::size_t s = 0; s < from_sun.size(); ++s) {
            from_sun[s] +=
                step.scattered *
                depth_toward(space.sun_field, medium, x, s, options.shadows).visibility();
        }
        if (!has_cells) continue;
        for (std::size_t c = 0; c < ImageSky::kCellCount; ++c) {
            if (!sky.part[c].is_dark) {
                from_part[c] +=
                    step.scattered *
                    depth_toward(space.cell_field, medium, x, c, options.shadows).visibility();
            }
        }
        if (options.is_open) {
            from_part[SkyView::kAhead] += step.scattered * std::exp(step.tau - options.steps.tau);
        }
    }
    glm::dvec3 sum(0);
    for (std::size_t s = 0; s < from_sun.size(); ++s) {
        const double cosine = glm::dot(glm::dvec3(ray.direction), suns[s].direction);
        sum += from_sun[s] * eval_phase(space.phase.density, std::clamp(cosine, -1.0, 1.0)) *
               suns[s].irradiance;
    }
    for (std::size_t c = 0; c < sky.part.size(); ++c) {
        sum += from_part[c] * sky.part[c].once;
    }
    return sum;
}

// Paths from one point along the ray to the lights.
class PathGatherer {
  public:
    PathGatherer(const ScatteringSpace& space, const ScatterOptions& options, glm::dvec3 start,
                 glm::dvec3 onward, double ell_onward)
        : space_(space),
          options_(options),
          medium_{space.volumes, options.band},
          start_(start),
          onward_(onward),
          ell_onward_(ell_onward) {}

    // The mean over paths toward a direction of the field.
    double gather(const ColumnField& field, std::size_t number, glm::dvec3 light,
                  const ZonalRow& kernel) const {
        const Turns turns(onward_, light);
        double sum = 0;
        if (space_.curvature) {
            for (const Turn& turn : turns) {
                sum += along(least_attenuated(turn), field, number, kernel);
            }
            return sum / static_cast<double>(turns.size());
        }
        for (const double length : space_.lengths) {
            const double ell_total = std::max(length * ell_onward_, kShortestTurn);
            for (const Turn& turn : turns) {
                sum += along(QuasiPath{start_, turn, ell_total}, field, number, kernel);
            }
        }
        return sum / static_cast<double>(space_.lengths.size() * turns.size());
    }

    // Light that enters where paths toward a direction of the field leave, [Premoze2003] (20, 21):
    // the mean over planes of e^-A kernel(ell), both depths up to there.
    double gather_at_end(const ColumnField& field, std::size_t number, glm::dvec3 light,
                         const ZonalRow& kernel) const {
        const Turns turns(onward_, light);
        double sum = 0;
        for (const Turn& turn : turns) {
            const QuasiPath path = least_attenuated(turn);
            glm::dvec3 last = start_;  // with density
            const PathEnd end =
                march_quasi_path(path, medium_, space_.limits, [&](const PathStep& step) {
                    last = step.depth > 0 ? step.position : last;
                    return std::exp(-step.absorption) > kLeastSurvival;
                });
            sum += std::exp(-end.absorption) * std::max(kernel(end.ell), 0.0) *
                   depth_toward(field, medium_, last, number, options_.shadows).open;
        }
        return sum / static_cast<double>(turns.size());
    }

  private:
    // Fidelity "paper".
    QuasiPath least_attenuated(const Turn& turn) const {
        return least_attenuated_path(start_, turn, ell_onward_, space_.lengths, *space_.curvature,
                                     medium_, space_.limits);
    }

    double along(const QuasiPath& path, const ColumnField& field, std::size_t number,
                 const ZonalRow& kernel) const {
        double sum = 0;
        march_quasi_path(path, medium_, space_.limits, [&](const PathStep& step) {
            if (!(step.depth > 0)) return true;
            const double survival = std::exp(-step.absorption);
            const FieldDepth toward =
                depth_toward(field, medium_, step.position, number, options_.shadows);
            sum += step.depth * survival * std::max(kernel(step.ell), 0.0) * toward.visibility();
            const bool leaves =
                step.ell > path.ell_total && toward.depth < kClear && toward.open == 1;
            return survival > kLeastSurvival && !leaves;
        });
        return sum;
    }

    const ScatteringSpace& space_;
    const ScatterOptions& options_;
    BandMedium medium_;
    glm::dvec3 start_, onward_;
    double ell_onward_;
};

// Paths that go straight on: along the view ray itself.
double gather_ahead(const ViewBand& steps, const ZonalRow& kernel) {
    double sum = 0;
    for (const ViewStep& step : steps.step) {
        sum += step.depth * std::exp(-step.absorption - steps.tau + step.tau) *
               std::max(kernel(step.ell), 0.0);
    }
    return sum;
}

// Toward all lights from one point.
glm::dvec3 gather_paths(const ScatteringSpace& space, const SkyView& sky,
                        const ScatterOptions& options, const PathGatherer& paths,
                        const ZonalTable& table, glm::dvec3 onward) {
    glm::dvec3 sum(0);
    for (std::size_t s = 0; options.suns && s < space.lights.suns.size(); ++s) {
        const ImageSun& sun = space.lights.suns[s];
        const ZonalRow row = interpolate_row(table, glm::dot(onward, sun.direction));
        sum += paths.gather(space.sun_field, s, sun.direction, row) * sun.irradiance;
    }
    for (std::size_t c = 0; c < ImageSky::kCellCount; ++c) {
        if (!sky.part[c].is_dark) {
            const auto gather =
                space.curvature ? &PathGatherer::gather_at_end : &PathGatherer::gather;
            sum += (paths.*gather)(space.cell_field, c, sky_cells()[c], sky.part[c].often) *
                   sky.part[c].color;
        }
    }
    return sum;
}

glm::dvec3 gather_from_entry(const ScatteringSpace& space, const ViewRay& ray, const SkyView& sky,
                             const ScatterOptions& options) {
    const glm::dvec3 onward(ray.direction);
    const PathGatherer paths(space, options,
                             glm::dvec3(ray.origin) + static_cast<double>(ray.entry) * onward,
                             onward, options.steps.ell);
    glm::dvec3 sum = gather_paths(space, sky, options, paths, space.phase.ray, onward);
    const SkyPart& ahead = sky.part[SkyView::kAhead];
    if (options.is_open && !ahead.is_dark) {
        const ViewBand& steps = options.steps;
        sum += (space.curvature ? std::exp(steps.ell - steps.tau) * ahead.often(steps.ell)
                                : gather_ahead(steps, ahead.often)) *
               ahead.color;
    }
    return sum;
}

glm::dvec3 gather_along_ray(const ScatteringSpace& space, const ViewRay& ray, const SkyView& sky,
                            const ScatterOptions& options) {
    const glm::dvec3 onward(ray.direction);
    const std::vector<ViewStep>& steps = options.steps.step;
    double total = 0;
    for (const ViewStep& step : steps) {
        total += step.scattered;
    }
    glm::dvec3 sum(0);
    double passed = 0;
    int point = 0;
    for (std::size_t i = 0; i < steps.size() && point < kSourcePoints; ++i) {
        passed += steps[i].scattered;
        const double share = total / kSourcePoints;
        int here = 0;  // points that fall into this step
        for (; point < kSourcePoints && passed >= (point + 0.5) * share; ++point) {
            ++here;
        }
        if (here > 0) {
            const PathGatherer paths(space, options, glm::dvec3(ray.position[i]), onward,
                                     options.steps.ell - steps[i].ell);
            sum +=
                here * share * gather_paths(space, sky, options, paths, space.phase.source, onward);
        }
    }
    return sum;
}

}  // namespace

RayLight gather_scattered(const ScatteringSpace& space, const ViewRay& ray, const SkyView& sky,
                          const ScatterOptions& options) {
    RayLight light;
    if (ray.is_empty()) return light;
    light.once = gather_once(space, ray, sky, options);
    if (options.often) {
        light.often = options.form == PathForm::ray ? gather_from_entry(space, ray, sky, options)
                                                    : gather_along_ray(space, ray, sky, options);
    }
    return light;
}

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
                if (ray.is_empty()) continue;
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
