#include "bake/cli/emitter_brightness.h"

#include <cmath>

#include "bake/environment/builtin_environment.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"

namespace opaline::cli {
namespace {

double sum_luminance(const formats::AssetView& view, const runtime::LightVector& sky,
                     std::span<const formats::Rgb> emitters) {
    std::vector<formats::Rgb> radiance(view.receivers());
    runtime::ShadeOptions options;
    options.emitters = {emitters, false};
    runtime::shade(view, sky, radiance, options);
    double sum = 0;
    for (const formats::Rgb value : radiance)
        sum += static_cast<double>(formats::luminance(value));
    return sum;
}

}  // namespace

std::vector<double> compare_with_sky(const formats::AssetView& view) {
    std::vector<double> times;
    if (view.emitters.empty()) return times;
    std::vector<formats::Rgb> colors(view.emitters.size());
    const auto light_of = [&](const formats::Environment& sky) {
        return runtime::project_environment(sky, view.cubemap_size, {});
    };
    const double white = sum_luminance(view, light_of(*bake::make_environment("white")), colors);
    const runtime::LightVector black = light_of({});
    for (formats::Rgb& color : colors) {
        color = {1, 1, 1};
        times.push_back(white > 0 ? sum_luminance(view, black, colors) / white : std::nan(""));
        color = {};
    }
    return times;
}

}  // namespace opaline::cli
