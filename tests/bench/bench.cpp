// opaline_bench NAME [ARGUMENT...]: a table or figure of RESULTS.md; `opaline_bench speed` runs the
// Google benchmarks, whose figures are ratios of two things measured in one run.
#include "tests/bench/bench.h"

#include <benchmark/benchmark.h>

#include <cstdio>
#include <string_view>

namespace opaline::tests {
namespace {

int speed(int count, char** arguments) {
    benchmark::Initialize(&count, arguments);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}

struct Entry {
    std::string_view name;
    int (*run)(int count, char** arguments);
};

constexpr Entry kEntries[] = {
    {"speed", speed},
    {"brute-force-table", brute_force_table},
    {"error-matrix", error_matrix},
    {"interreflection-table", interreflection_table},
    {"model-table", model_table},
    {"radiosity-figure", radiosity_figure},
    {"slab-accuracy", slab_accuracy},
    {"texture-filter", texture_filter},
    {"volume-relight", volume_relight},
    {"walk-table", walk_table},
    {"write-cloud", write_cloud},
};

}  // namespace
}  // namespace opaline::tests

int main(int count, char** arguments) {
    for (const opaline::tests::Entry& entry : opaline::tests::kEntries) {
        if (count > 1 && arguments[1] == entry.name) return entry.run(count - 1, arguments + 1);
    }
    std::fputs("usage: opaline_bench NAME [ARGUMENT...], NAME one of:\n", stderr);
    for (const opaline::tests::Entry& entry : opaline::tests::kEntries) {
        std::fprintf(stderr, "  %s\n", entry.name.data());
    }
    return 2;
}
