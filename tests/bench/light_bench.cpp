// What changes of light and loading cost a host, through opaline.h. Arguments: side of the basis,
// and what the asset mirrors: 0 nothing, 1 gloss of opaque surfaces, 2 a translucent mirror, 3
// both. `ms` is the fastest of the run; `of_checksum` the ratio of loading to one pass of XXH3 over
// the same bytes.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <random>
#include <vector>

#include "formats/opal/file_bytes.h"
#include "formats/opal/openness.h"
#include "formats/opal/section.h"
#include "formats/opal/write_opal.h"
#include "runtime/light_vector.h"
#include "runtime/opaline.hpp"

namespace {

using namespace opaline;
using Clock = std::chrono::steady_clock;

double fastest(int runs, const std::function<void()>& work) {
    double best = INFINITY;
    for (int i = 0; i < runs; ++i) {
        const Clock::time_point start = Clock::now();
        work();
        best = std::min(best, std::chrono::duration<double>(Clock::now() - start).count());
    }
    return best;
}

// Rows of `details` coefficients each; what they hold does not matter here.
formats::Asset make_asset(std::uint32_t n, int mirrors, std::uint32_t rows, std::uint32_t details) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> unit(-0.5f, 0.5f);
    formats::Asset asset;
    asset.provenance = "{}";
    asset.transport = formats::make_sparse_rows(n, 8);
    formats::SparseRow row;
    row.bands = 3;
    for (std::uint32_t i = 0; i < details; ++i) {
        row.index.push_back(2 * i + 1 + i / (n * n / 4));
    }
    row.average.assign(18, 0.3f);
    for (std::uint32_t i = 0; i < 3 * details; ++i) {
        row.value.push_back(unit(generator));
    }
    for (std::uint32_t r = 0; r < rows; ++r) {
        formats::append_row(asset.transport, row);
    }
    formats::PrimitiveRecord opaque, clear;
    opaque.vertex_count = rows / 2;
    opaque.bands = clear.bands = 3;
    clear.shading = formats::Shading::translucent;
    clear.eta = 1.5f;
    clear.first_vertex = clear.first_row = rows / 2;
    clear.first_band_row = 3 * (rows / 2);
    clear.first_code = 3 * details * (rows / 2);
    clear.vertex_count = rows - rows / 2;
    asset.primitives = {opaque, clear};
    for (std::uint32_t v = 0; v < rows; ++v) {
        asset.position.push_back({unit(generator), unit(generator), unit(generator)});
        asset.normal.push_back(formats::normalize(asset.position.back() + formats::Vec3{0, 1, 0}));
        asset.base_color.push_back({0.5f, 0.5f, 0.5f});
        asset.openness.push_back(formats::encode_openness({0, 1, 0}, 1));
    }
    asset.roughness = {-1, (mirrors & 2) != 0 ? 0.05f : -1.0f};
    if ((mirrors & 1) != 0) {
        formats::GlossRecord gloss, none;
        gloss.roughness = 0.3f;
        gloss.f0 = {0.04f, 0.04f, 0.04f};
        gloss.f90 = 1;
        none.roughness = -1;
        asset.gloss = {gloss, none};
    }
    return asset;
}

struct Loaded {
    formats::FileBytes bytes;
    AssetHandle asset;
};

Loaded load(const formats::Asset& asset) {
    const auto path = std::filesystem::temp_directory_path() / "opaline-light-bench.opal";
    auto file = formats::AtomicFile::create(path);
    if (!file || !formats::write_opal(asset.view(), std::move(*file))) std::abort();
    auto bytes = formats::FileBytes::open(path);
    std::filesystem::remove(path);
    if (!bytes) std::abort();
    Loaded loaded{std::move(*bytes), {}};
    loaded.asset = load_asset(loaded.bytes.bytes().data(), loaded.bytes.bytes().size()).handle;
    if (loaded.asset == nullptr) std::abort();
    return loaded;
}

// A gradient with fine structure, and a sun of two hundred pixels.
std::vector<float> make_map() {
    std::vector<float> rgb;
    for (int y = 0; y < 512; ++y) {
        for (int x = 0; x < 1024; ++x) {
            const float grain = 1 + 0.5f * std::sin(0.3f * static_cast<float>(x)) *
                                        std::sin(0.4f * static_cast<float>(y));
            const bool sun = (x - 300) * (x - 300) + (y - 100) * (y - 100) < 64;
            const float value = (sun ? 2e4f : 1.0f) * grain;
            rgb.insert(rgb.end(), {value, 0.9f * value, 0.8f * value});
        }
    }
    return rgb;
}

void check(opaline_status status) {
    if (status != OPALINE_OK) std::abort();
}

void change_light(benchmark::State& state) {
    const auto n = static_cast<std::uint32_t>(state.range(0));
    const Loaded file = load(make_asset(n, static_cast<int>(state.range(1)), 100, 8));
    const LightHandle light = create_light(file.asset).handle;
    opaline_light* const l = light.get();
    check(opaline_light_set_threads(l, 2));
    const std::vector<float> map = make_map();
    const float up[3] = {0.1f, 1, 0.2f}, white[3] = {1e4f, 1e4f, 1e4f};
    float angle = 0;
    const auto matrix = [&] {
        angle += 0.1f;
        const runtime::Rotation r = runtime::rotation_about_y(angle);
        return std::array<float, 9>{r.x.x, r.x.y, r.x.z, r.y.x, r.y.y, r.y.z, r.z.x, r.z.y, r.z.z};
    };
    double set_map = INFINITY, turn = INFINITY, sun = INFINITY;
    for (auto _ : state) {
        set_map = std::min(set_map, fastest(1, [&] {
                               check(opaline_light_set_lat_long(l, map.data(), 1024, 512));
                           }));
        turn = std::min(turn, fastest(5, [&] { check(opaline_light_turn(l, matrix().data())); }));
        if (sun == INFINITY) check(opaline_light_add_sun(l, up, 0.00465f, white));
        sun = std::min(
            sun, fastest(1, [&] { check(opaline_light_set_sun(l, 0, up, 0.00465f, white)); }));
    }
    state.counters["map_ms"] = 1e3 * set_map;
    state.counters["turn_ms"] = 1e3 * turn;
    state.counters["sun_ms"] = 1e3 * sun;
}
BENCHMARK(change_light)
    ->ArgNames({"n", "mirrors"})
    ->ArgsProduct({{16, 32, 64, 128}, {0}})
    ->ArgsProduct({{32}, {1, 2, 3}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(1.0);

void load_file(benchmark::State& state) {
    const Loaded file = load(make_asset(32, 0, static_cast<std::uint32_t>(state.range(0)), 128));
    const std::span<const std::byte> bytes = file.bytes.bytes();
    opaline_load_options trusted{};
    trusted.struct_size = sizeof trusted;
    trusted.flags = OPALINE_LOAD_TRUSTED;
    const auto load_with = [&](const opaline_load_options* options) {
        opaline_asset* asset = nullptr;
        check(opaline_asset_load_with(bytes.data(), bytes.size(), options, &asset));
        opaline_asset_release(asset);
    };
    double checked = INFINITY, unchecked = INFINITY, checksum = INFINITY;
    for (auto _ : state) {
        checked = std::min(checked, fastest(1, [&] { load_with(nullptr); }));
        unchecked = std::min(unchecked, fastest(1, [&] { load_with(&trusted); }));
        checksum = std::min(checksum, fastest(1, [&] {
                                std::uint64_t sum = formats::checksum(bytes);
                                benchmark::DoNotOptimize(sum);
                            }));
    }
    state.counters["MB"] = 1e-6 * static_cast<double>(bytes.size());
    state.counters["load_ms"] = 1e3 * checked;
    state.counters["trusted_ms"] = 1e3 * unchecked;
    state.counters["load_of_checksum"] = checked / checksum;
    state.counters["trusted_of_checksum"] = unchecked / checksum;
}
BENCHMARK(load_file)
    ->ArgName("receivers")
    ->Arg(100000)
    ->Arg(400000)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(1.0);

}  // namespace
