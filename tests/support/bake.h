#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "bake/lights/builtin_environment.h"
#include "bake/pipeline/pipeline.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"
#include "tests/support/effects.h"
#include "tests/support/scenes.h"

namespace opaline::tests {

/// Beside the test program: its cases share the test lights, which take longer than many a bake.
inline std::filesystem::path test_cache() {
    return std::filesystem::read_symlink("/proc/self/exe") += ".cache";
}

/// Options out of range throw std::invalid_argument: the test fails by name.
inline bake::BakeResult bake_scene(const formats::Scene& scene, const bake::BakeOptions& options) {
    bake::Context context;
    context.threads = options.threads;
    context.cache = test_cache();
    const auto knobs = bake::resolve_knobs(options);
    if (!knobs) {
        throw std::invalid_argument(knobs.error().diagnostics.front().fault);
    }
    auto result = bake::run_bake(scene, *knobs, context);
    EXPECT_TRUE(result);
    return std::move(result).value();
}

/// Whether a stage ran whose name starts so.
inline bool has_stage(const bake::BakeResult& result, std::string_view start) {
    return std::any_of(result.stages.begin(), result.stages.end(),
                       [&](const auto& s) { return s.name.starts_with(start); });
}

/// A built-in light in the basis of n x n texels a face.
inline runtime::LightVector make_light(const char* name, std::uint32_t n) {
    const auto environment = bake::make_environment(name);
    EXPECT_TRUE(environment);
    return runtime::project_environment(*environment, n);
}

/// Outgoing radiance of every receiver.
inline std::vector<formats::Rgb> relight(const formats::AssetView& asset,
                                         const runtime::LightVector& light) {
    std::vector<formats::Rgb> radiance(asset.receivers());
    runtime::shade(asset, light, radiance, {});
    return radiance;
}
inline std::vector<formats::Rgb> relight(const formats::AssetView& asset, const char* light) {
    return relight(asset, make_light(light, asset.cubemap_size));
}

/// A ball with dents that shadow each other, hovering over a floor.
inline formats::Scene make_dented_ball() {
    auto ball = make_sphere(3, 1, {0, 1.1f, 0});
    for (std::size_t v = 0; v < ball.position.size(); ++v) {
        const glm::vec3 n = ball.normal[v];
        ball.position[v] += 0.15f * std::sin(7 * n.x) * std::sin(6 * n.y) * std::sin(8 * n.z) * n;
    }
    return make_scene({ball, make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 20)});
}

}  // namespace opaline::tests
