// What relighting the volumes of a file takes a host, through opaline.h:
//
//   opaline_bench volume-relight FILE.opal [LIGHT]     LIGHT: a built-in name or a file
//
// Prints a table as markdown, milliseconds of wall time and of all threads together: even light,
// one sun, five suns in different directions, the map of LIGHT. Medians of 15 and the fastest.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "bake/lights/builtin_environment.h"
#include "formats/opal/file_bytes.h"
#include "runtime/opaline.hpp"
#include "tests/bench/bench.h"

namespace {

using namespace opaline;
using Clock = std::chrono::steady_clock;

void check(opaline_status status) {
    if (status == OPALINE_OK) return;
    std::fprintf(stderr, "%s\n", opaline_last_error());
    std::exit(1);
}

constexpr int kRuns = 15;

void print_row(const char* name, const opaline_asset* asset, const opaline_light* light,
               opaline_volume_light* volumes, unsigned threads) {
    std::vector<double> wall, user;
    for (int i = 0; i < kRuns; ++i) {
        const Clock::time_point start = Clock::now();
        const std::clock_t work = std::clock();
        check(opaline_volume_light_update(volumes, asset, light, OPALINE_SHADE_DEFAULT, threads));
        user.push_back(1e3 * static_cast<double>(std::clock() - work) / CLOCKS_PER_SEC);
        wall.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    std::ranges::sort(wall);
    std::ranges::sort(user);
    std::printf("| %s, %u threads | %.1f | %.1f | %.1f |\n", name, threads, wall[kRuns / 2],
                wall[0], user[kRuns / 2]);
}

}  // namespace

int opaline::tests::volume_relight(int argc, char** argv) {
    if (argc < 2 || argc > 3) {
        std::fputs("usage: opaline_bench volume-relight FILE.opal [LIGHT]\n", stderr);
        return 2;
    }
    const auto bytes = formats::FileBytes::open(argv[1]);
    if (!bytes) {
        std::fprintf(stderr, "%s cannot be read\n", argv[1]);
        return 1;
    }
    const auto asset = load_asset(bytes->bytes().data(), bytes->bytes().size());
    check(asset.status);
    if (opaline_asset_volume_count(asset.handle.get()) == 0) {
        std::fprintf(stderr, "%s has no volumes\n", argv[1]);
        return 1;
    }
    const auto light = create_light(asset.handle);
    const auto volumes = create_volume_light(asset.handle);
    check(light.status);
    check(volumes.status);
    opaline_light* const l = light.handle.get();
    const auto print = [&](const char* name) {
        for (const unsigned threads : {1u, 2u}) {
            print_row(name, asset.handle.get(), l, volumes.handle.get(), threads);
        }
    };
    std::printf("| light | median, ms | fastest, ms | user, ms |\n|---|---:|---:|---:|\n");
    const std::array<float, 27> even{3, 3, 3};
    check(opaline_light_set_harmonics(l, even.data()));
    print("even");
    const float power[3] = {1e4f, 1e4f, 1e4f};
    const std::array<std::array<float, 3>, 5> suns{
        {{0.1f, 1, 0.2f}, {1, 0.3f, 0.4f}, {-0.6f, 0.5f, 0.2f}, {0.2f, 0.3f, -1}, {-1, 0.2f, -1}}};
    for (std::size_t i = 0; i < suns.size(); ++i) {
        check(opaline_light_add_sun(l, suns[i].data(), 0.00465f, power));
        if (i == 0) print("one sun");
    }
    print("five suns");
    if (argc == 3) {
        const auto map = bake::open_environment(argv[2]);
        if (!map) {
            std::fprintf(stderr, "%s cannot be read\n", argv[2]);
            return 1;
        }
        check(opaline_light_clear(l));
        std::vector<float> rgb;
        for (const formats::Rgb& p : map->environment.pixel) {
            rgb.insert(rgb.end(), {p.r, p.g, p.b});
        }
        check(opaline_light_set_lat_long(l, rgb.data(), map->environment.width,
                                         map->environment.height));
        print("map");
    }
    return 0;
}
