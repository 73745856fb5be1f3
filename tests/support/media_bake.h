#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bake/effects/multiple/multiple_stage.h"
#include "tests/support/bake.h"
#include "tests/support/effects.h"
#include "tests/support/media.h"

namespace opaline::tests {

/// Enough for whole bakes of small bodies in a second or so. By the dipole: tests of walks say so.
inline bake::BakeOptions small_bake() {
    bake::BakeOptions options;
    options.cubemap_size = 8;
    options.coefficients = bake::kAllCoefficients;
    options.set(bake::kSamples, 3000);
    options.set(bake::kDepthSamples, 4);
    options.set(bake::kMultipleModel, static_cast<double>(bake::MultipleModel::dipole));
    options.threads = 2;
    return options;
}

inline bake::BakeOptions only(std::vector<std::string> effects) {
    bake::BakeOptions options = small_bake();
    options.effects = std::move(effects);
    return options;
}

/// A ball of the medium, the first primitive, above a white floor.
inline Scene make_ball_on_floor(const formats::Medium& medium) {
    Primitive floor = make_quad({-3, -1.02f, -3}, {0, 0, 6}, {6, 0, 0}, 6);
    floor.material = 1;
    return make_translucent_scene({make_sphere(2), floor}, medium);
}

inline double mean_green(const std::vector<formats::Rgb>& radiance) {
    double sum = 0;
    for (const formats::Rgb& c : radiance) {
        sum += double{c.g} / static_cast<double>(radiance.size());
    }
    return sum;
}

/// Radiance of the vertices of one primitive, each seen along its normal.
inline std::vector<formats::Rgb> relight_primitive(const formats::Asset& asset, const char* light,
                                                   std::size_t primitive = 0,
                                                   const runtime::ShadeOptions& options = {}) {
    std::vector<formats::Rgb> radiance(asset.position.size());
    runtime::shade(asset.view(), make_light(light, asset.view().cubemap_size), radiance, options);
    const formats::PrimitiveRecord& record = asset.primitives[primitive];
    return {radiance.begin() + record.first_vertex,
            radiance.begin() + record.first_vertex + record.vertex_count};
}

/// RMS of the difference over RMS of the reference, all bands.
inline double relative_rms(const std::vector<formats::Rgb>& a,
                           const std::vector<formats::Rgb>& reference) {
    double error = 0, sum = 0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        const formats::Rgb d{a[i].r - reference[i].r, a[i].g - reference[i].g,
                             a[i].b - reference[i].b};
        error += double{d.r} * d.r + double{d.g} * d.g + double{d.b} * d.b;
        const formats::Rgb& r = reference[i];
        sum += double{r.r} * r.r + double{r.g} * r.g + double{r.b} * r.b;
    }
    return sum > 0 ? std::sqrt(error / sum) : std::sqrt(error);
}

/// The largest difference between the radiance of any two vertices, in any band.
inline double largest_difference(const formats::Asset& a, const formats::Asset& b,
                                 const char* light, const runtime::ShadeOptions& options = {}) {
    const auto shade = [&](const formats::Asset& asset) {
        std::vector<formats::Rgb> radiance(asset.position.size());
        runtime::shade(asset.view(), make_light(light, asset.view().cubemap_size), radiance,
                       options);
        return radiance;
    };
    const auto x = shade(a), y = shade(b);
    double largest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        largest = std::max({largest, std::abs(double{x[i].r} - y[i].r),
                            std::abs(double{x[i].g} - y[i].g), std::abs(double{x[i].b} - y[i].b)});
    }
    return largest;
}

/// The largest radiance of a built-in map without discs, in any band.
inline double peak_of(const char* light) {
    const formats::Environment environment = bake::make_environment(light).value();
    float peak = 0;
    for (const formats::Rgb c : environment.pixel) {
        peak = std::max({peak, c.r, c.g, c.b});
    }
    return static_cast<double>(peak);
}

/// Every number that a file holds for its receivers is finite.
inline bool all_finite(const formats::Asset& asset) {
    const auto finite = [](float x) { return std::isfinite(x); };
    const auto& rows = asset.transport;
    return std::all_of(rows.average_scale.begin(), rows.average_scale.end(), finite) &&
           std::all_of(rows.detail_scale.begin(), rows.detail_scale.end(), finite) &&
           std::all_of(asset.base_color.begin(), asset.base_color.end(),
                       [&](formats::Rgb c) { return finite(c.r) && finite(c.g) && finite(c.b); });
}

}  // namespace opaline::tests
