// How close the sparse dot product comes to reading its own bytes. `ratio` is the time of the dot
// product divided by the time of streaming the same bytes of the rows, both the fastest of the same
// run. Rows of 128 coefficients, six averages among them, n = 16 (preview's) or 32. 100 000 of them
// partly stay in the last cache, which flatters streaming.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <random>
#include <set>

#include "formats/opal/cubemap.h"
#include "runtime/parallel.h"
#include "runtime/shade.h"

namespace {

using namespace opaline;
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kDetails = 122, kRows = 100000;

formats::Asset make_dot_asset(std::uint32_t bands, std::uint32_t size) {
    std::mt19937 generator(1);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    // A thousand different rows, repeated: making them is not what is measured.
    std::vector<formats::SparseRow> kinds(1000);
    for (formats::SparseRow& row : kinds) {
        std::set<std::uint32_t> index;
        while (index.size() < kDetails) {
            // Baked rows prefer coarse coefficients, which stand near the corner of a face.
            const auto coordinate = [&] {
                const float x = unit(generator);
                return static_cast<std::uint32_t>(x * x * static_cast<float>(size));
            };
            const auto face = static_cast<std::uint32_t>(unit(generator) * 5.999f);
            const std::uint32_t k = (face * size + coordinate()) * size + coordinate();
            if (k % (size * size) != 0) {
                index.insert(k);
            }
        }
        row.bands = bands;
        row.index.assign(index.begin(), index.end());
        for (std::uint32_t i = 0; i < kDetails * bands; ++i) {
            row.value.push_back(unit(generator) - 0.5f);
        }
        row.average.assign(std::size_t{6} * bands, 0.3f);
    }
    formats::Asset asset;
    asset.transport = formats::make_sparse_rows(size, 8);
    for (std::uint32_t r = 0; r < kRows; ++r) {
        formats::append_row(asset.transport, kinds[r % kinds.size()]);
    }
    formats::PrimitiveRecord primitive;
    primitive.vertex_count = kRows;
    primitive.bands = bands;
    asset.primitives = {primitive};
    asset.position.resize(kRows);
    asset.normal.resize(kRows);
    asset.base_color.resize(kRows, {1, 1, 1});
    return asset;
}

template <class T>
std::uint64_t sum_words(std::span<const T> values, std::uint32_t part, std::uint32_t parts) {
    const auto bytes = std::as_bytes(values);
    const std::size_t words = bytes.size() / 8;
    std::uint64_t sum = 0;
    for (std::size_t i = words * part / parts; i < words * (part + 1) / parts; ++i) {
        std::uint64_t word = 0;
        std::memcpy(&word, &bytes[8 * i], 8);
        sum += word;
    }
    return sum;
}

// Reads every byte that rows consist of once and does as little as possible with it.
void stream(const formats::SparseRowsView& rows) {
    constexpr std::uint32_t kParts = 64;
    runtime::for_ranges(kParts, 1, 0, [&](std::uint32_t part, std::uint32_t) {
        std::uint64_t sum =
            sum_words(rows.index16, part, kParts) + sum_words(rows.code8, part, kParts) +
            sum_words(rows.row_offset, part, kParts) + sum_words(rows.average_scale, part, kParts) +
            sum_words(rows.detail_scale, part, kParts) + sum_words(rows.average_code, part, kParts);
        benchmark::DoNotOptimize(sum);
    });
}

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void dot_against_stream(benchmark::State& state) {
    const auto bands = static_cast<std::uint32_t>(state.range(0));
    const auto size = static_cast<std::uint32_t>(state.range(1));
    const formats::Asset asset = make_dot_asset(bands, size);
    const formats::AssetView view = asset.view();
    formats::Environment sky;
    sky.discs.push_back({{0, 1, 0}, 0.5f, {1, 1, 1}});
    const runtime::LightVector light = runtime::project_environment(sky, size);
    std::vector<formats::Rgb> out(view.receivers());
    runtime::ShadeOptions options;
    options.base_color = false;
    options.path = static_cast<runtime::DotPath>(state.range(2));
    if (options.path > runtime::best_dot_path()) {
        state.SkipWithError("not on this processor");
        return;
    }
    double best_dot = INFINITY, best_stream = INFINITY;
    for (auto _ : state) {
        const Clock::time_point start = Clock::now();
        runtime::shade(view, light, out, options);
        benchmark::DoNotOptimize(out.data());
        best_dot = std::min(best_dot, seconds_since(start));
        const Clock::time_point then = Clock::now();
        stream(view.transport);
        best_stream = std::min(best_stream, seconds_since(then));
    }
    state.counters["ratio"] = best_dot / best_stream;
}

BENCHMARK(dot_against_stream)
    ->ArgNames({"bands", "n", "path"})
    ->ArgsProduct({{1, 3}, {16, 32}, {1, 2}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(0.3);

}  // namespace
