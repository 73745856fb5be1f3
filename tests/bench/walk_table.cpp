// What balls save random walks (bake/effects/multiple/walks/README.md, "Balls"): events, rays and
// seconds of processor time a walk without and with them, in turns. Rows of RESULTS.md's table:
// opaline_bench walk-table SCENE LENGTH,ALBEDO,G... with the media of opaline_bench error-matrix.
#include <cmath>
#include <cstdio>
#include <ctime>
#include <span>
#include <vector>

#include "bake/effects/multiple/walks/site_rows.h"
#include "bake/effects/multiple/walks/walk.h"
#include "bake/effects/multiple/walks/walk_stage.h"
#include "bake/receivers/surface_samples.h"
#include "tests/bench/bench.h"
#include "tests/bench/grey_cells.h"

namespace opaline::bake {
namespace {

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Measured {
    WalkCounts counts;
    double seconds = 0, light = 0, square = 0;  // what leaves a walk
};

void follow(const WalkSpace& space, std::span<const WalkStart> starts, std::uint32_t round,
            Measured& measured) {
    constexpr std::uint32_t kFromEach = 100;
    std::vector<WalkExit> exits;
    const double before = processor_seconds();
    for (std::uint32_t s = 0; s < starts.size(); ++s) {
        for (std::uint32_t w = 0; w < kFromEach; ++w) {
            WalkRandom random({0, RandomStage::body_walk, s, round * kFromEach + w});
            exits.clear();
            follow_walk(space, {}, starts[s], {1}, random, exits, measured.counts);
            double light = 0;
            for (const WalkExit& exit : exits) {
                light += static_cast<double>(exit.weight[0]);
            }
            measured.light += light;
            measured.square += light * light;
        }
    }
    measured.seconds += processor_seconds() - before;
}

void print_cell(const formats::Scene& scene) {
    constexpr std::uint32_t kSites = 120, kRounds = 6;
    constexpr double kWalks = 12e6;  // as at production
    const EmbreeScene triangles = EmbreeScene::build(scene, 1, true).value();
    const WalkSpace plain = make_walk_space(scene, triangles, 0, true);
    WalkSpace with_balls = plain;
    double before = processor_seconds();
    Context one;
    one.threads = 1;
    add_balls(with_balls, kWalks, 1, one);
    const double making = processor_seconds() - before;
    std::vector<std::uint32_t> primitives;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        if (scene.primitives[p].material == 0) {
            primitives.push_back(p);
        }
    }
    const auto sites = sample_surface(scene, primitives, kSites, 7, one);
    const auto starts = make_walk_starts(plain, sites, one);
    Measured without, with;
    for (std::uint32_t round = 0; round < kRounds; ++round) {
        follow(plain, starts, round, without);
        follow(with_balls, starts, round, with);
    }
    const auto& balls = with_balls.balls.front();
    std::printf(" %zu radii, %.2f s |", balls ? balls->radii() : 0, making);
    for (const Measured& m : {without, with}) {
        const auto walks = static_cast<double>(m.counts.walks);
        const double mean = m.light / walks;
        std::printf(
            " %.1f events, %.1f rays, %.2f jumps, %.2f searches, %.2f us, light %.4f +- %.4f |",
            static_cast<double>(m.counts.events) / walks,
            static_cast<double>(m.counts.rays) / walks, static_cast<double>(m.counts.jumps) / walks,
            static_cast<double>(m.counts.searches) / walks, 1e6 * m.seconds / walks, mean,
            std::sqrt((m.square / walks - mean * mean) / walks));
    }
    std::printf(" %.2f times |\n", without.seconds / with.seconds);
}

}  // namespace
}  // namespace opaline::bake

int opaline::tests::walk_table(int count, char** argument) {
    return opaline::bake::print_grey_cells(count, argument, opaline::bake::print_cell);
}
