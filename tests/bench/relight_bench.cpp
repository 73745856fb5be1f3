// Relights a second of the file OPALINE_BENCH_ASSET names: every receiver's radiance under another
// light, on one core, on all, and in OpenGL's compute shader where there is a device.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <optional>
#include <utility>
#include <vector>

#include "formats/opal/file_bytes.h"
#include "formats/opal/read_opal.h"
#include "runtime/gl/gl_renderer.h"
#include "runtime/shade.h"

namespace {

using namespace opaline;

struct File {
    formats::FileBytes bytes;
    formats::LoadedAsset asset;
};

std::optional<File> open_file(benchmark::State& state) {
    const char* const path = std::getenv("OPALINE_BENCH_ASSET");
    if (path == nullptr) {
        state.SkipWithError("set OPALINE_BENCH_ASSET to an .opal file");
        return std::nullopt;
    }
    auto bytes = formats::FileBytes::open(path);
    if (!bytes) {
        state.SkipWithError(bytes.error().diagnostics.front().fault.c_str());
        return std::nullopt;
    }
    auto asset = formats::read_opal(bytes->bytes(), path);
    if (!asset) {
        state.SkipWithError(asset.error().diagnostics.front().fault.c_str());
        return std::nullopt;
    }
    return File{std::move(*bytes), std::move(*asset)};
}

formats::Environment make_gradient() {
    formats::Environment environment;
    environment.width = 64;
    environment.height = 32;
    for (std::uint32_t i = 0; i < 64 * 32; ++i) {
        const float x = static_cast<float>(i % 64) / 64, y = static_cast<float>(i / 64) / 32;
        environment.pixel.push_back({1 + x, 1 + y, 2 - x * y});
    }
    return environment;
}

void on_cpu(benchmark::State& state) {
    const auto file = open_file(state);
    if (!file) return;
    const formats::AssetView& asset = file->asset.view;
    const auto light = runtime::project_environment(make_gradient(), asset.cubemap_size);
    std::vector<formats::Rgb> radiance(asset.receivers());
    runtime::ShadeOptions options;
    options.threads = static_cast<unsigned>(state.range(0));
    for (auto _ : state) {
        runtime::shade(asset, light, radiance, options);
        benchmark::DoNotOptimize(radiance.data());
    }
    state.counters["relights/s"] =
        benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(on_cpu)->Arg(1)->Arg(0)->UseRealTime()->Unit(benchmark::kMillisecond);

void on_gl(benchmark::State& state) {
    const auto file = open_file(state);
    if (!file) return;
    const formats::Environment environment = make_gradient();
    auto renderer = runtime::GlRenderer::create(file->asset.view, environment);
    if (!renderer) {
        state.SkipWithError(renderer.error().diagnostics.front().fault.c_str());
        return;
    }
    const auto light = runtime::project_environment(environment, file->asset.view.cubemap_size);
    for (auto _ : state) {
        if (!renderer->set_light(light, {})) {
            state.SkipWithError("the light could not be set");
            return;
        }
        // Of a whole call, specular light on the CPU included, the part that each vertex costs.
        state.SetIterationTime(renderer->stats().light_seconds + renderer->stats().dot_seconds);
    }
    state.SetLabel(renderer->stats().device);
    state.counters["relights/s"] =
        benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(on_gl)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
