#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "bake/check/pilot/pilot.h"
#include "bake/check/pilot/refinement.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

ErrorBounds around(double rms, double standard_error) {
    return {rms, rms - 2 * standard_error, rms + 2 * standard_error};
}

TEST(ChooseEncoding, TheFirstThatIsSureElseTheFirstHardlyLessSureThanTheSurestIsTaken) {
    struct Row {
        const char* what;
        std::vector<double> errors;
        double deviation, target;
        std::size_t taken;
    };
    for (const Row& row : {
             Row{"1.9 % is likely but not sure", {0.030, 0.019, 0.016, 0.010}, 1e-3, 0.02, 2},
             Row{"all are sure", {0.030, 0.019, 0.016, 0.010}, 1e-3, 0.05, 0},
             Row{"a floor of noise", {0.0150, 0.0096, 0.0091, 0.0090}, 6e-4, 0.01, 2},
             Row{"none is likely", {0.15, 0.103, 0.1}, 1e-3, 0.01, 1},
             Row{"near the surest, but not likely", {0.0098, 0.0094, 0.0094}, 3e-4, 0.01, 1},
         }) {
        std::vector<ErrorBounds> errors;
        for (const double error : row.errors)
            errors.push_back(around(error, row.deviation));
        EXPECT_EQ(choose_encoding(errors, row.target), row.taken) << row.what;
    }
}

TEST(ChooseEncoding, ACheckWithNoiseOfItsOwnFindsMoreThanIsSureInOneOfFortyCases) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 1e-3);
    int above = 0;
    constexpr int kCases = 20000;
    for (int i = 0; i < kCases; ++i) {
        const double pilot = 0.02 + noise(random), check = 0.02 + noise(random);
        above += check > sure_error(around(pilot, 1e-3)) ? 1 : 0;
    }
    // 1 - Phi(2) = 2.275 %, to five standard errors of this count.
    const double expected = 0.5 * std::erfc(std::numbers::sqrt2);
    EXPECT_NEAR(above / double{kCases}, expected, 5 * std::sqrt(expected / kCases));
}

Knobs asking_for(double error) {
    BakeOptions options;
    options.error = error;
    return *resolve_knobs(options);
}

// What a scene errs by: of lights without suns, and of all of them.
struct Errors {
    double smooth, all;
};
using ErrorModel = std::function<Errors(const Knobs&)>;

struct Search {
    std::vector<Knobs> tried;
    PilotRound base;
};

// As the bake does it: until the target is met or nothing is left.
Search search(const Knobs& first, const ErrorModel& model) {
    Search search;
    Refinement refinement;
    std::optional<Knobs> next = first;
    while (next && search.tried.size() < 100) {
        const Knobs tried = *next;
        search.tried.push_back(tried);
        const Errors errors = model(tried);
        learn(refinement, {tried, true, errors.all, errors.smooth});
        next =
            errors.all <= tried.error_target ? std::nullopt : next_knobs(all_effects(), refinement);
    }
    search.base = *refinement.base;
    return search;
}

TEST(Refinement, AnErrorThatNoKnobLowersIsFoundOutInThreeRoundsAndTheCoarsestStays) {
    const Search cut_phase = search(asking_for(0.05), [](const Knobs&) {
        return Errors{0.09, 0.09};
    });
    ASSERT_EQ(cut_phase.tried.size(), 3u);
    EXPECT_GT(cut_phase.tried[1][kSamplesPerPath], cut_phase.tried[0][kSamplesPerPath]);
    EXPECT_GT(cut_phase.tried[2].cubemap_size, cut_phase.tried[0].cubemap_size);
    EXPECT_EQ(cut_phase.tried[2][kSamplesPerPath], cut_phase.tried[0][kSamplesPerPath])
        << "samples that did not help were kept";
    EXPECT_EQ(cut_phase.base.knobs.cubemap_size, cut_phase.tried[0].cubemap_size);
    EXPECT_EQ(cut_phase.base.knobs[kSamplesPerPath], cut_phase.tried[0][kSamplesPerPath]);
}

// A shadow's edge: the share of receivers under it halves with each doubling of the texels, and
// the RMS falls by the root of that.
Errors shadow_edge(const Knobs& knobs) {
    return {0.001, 0.06 * std::sqrt(16.0 / knobs.cubemap_size)};
}

TEST(Refinement, ShadowEdgesTakeAsManyTexelsAsTheyNeed) {
    const Search edge = search(asking_for(0.035), shadow_edge);
    EXPECT_EQ(edge.base.knobs.cubemap_size, 64u);
    EXPECT_LE(edge.base.error, 0.035);
    EXPECT_EQ(edge.tried.size(), 4u);
}

TEST(Refinement, TexelsThatCannotReachTheTargetAreNotPaidFor) {
    // 128 texels would leave 2.1 %.
    const Search edge = search(asking_for(0.02), shadow_edge);
    EXPECT_EQ(edge.base.knobs.cubemap_size, 32u) << "two rounds show the rate";
    EXPECT_EQ(edge.tried.size(), 2u);
}

TEST(Refinement, ErrorsOfSoftLightTakeMoreSamplesAndThoseOfSunsMoreTexels) {
    const Search both = search(asking_for(0.02), [](const Knobs& knobs) {
        const double smooth = 0.03 / std::sqrt(knobs[kSamplesPerPath]);
        return Errors{smooth, std::hypot(smooth, 0.02 * std::sqrt(16.0 / knobs.cubemap_size))};
    });
    EXPECT_LE(both.base.error, 0.02);
    EXPECT_GT(both.base.knobs[kSamplesPerPath], 4.0);
    EXPECT_GT(both.base.knobs.cubemap_size, 16u);
}

TEST(Refinement, WhatTheUserGaveStays) {
    BakeOptions options;
    options.error = 0.01;
    options.set(kSamples, 2000);
    options.cubemap_size = 8;
    options.coefficients = 64;
    const Search given = search(*resolve_knobs(options), shadow_edge);
    EXPECT_EQ(given.tried.size(), 1u);
    EXPECT_EQ(given.base.knobs.coefficients, 64u);
}

TEST(Refinement, EndsForErrorsThatFallSlowlyForeverAndForNone) {
    const auto slowly = [](const Knobs& knobs) {
        const double gain =
            std::pow(knobs[kSamplesPerPath], -0.1) * std::pow(knobs.cubemap_size, -0.2);
        return Errors{gain, gain};
    };
    EXPECT_LT(search(asking_for(1e-4), slowly).tried.size(), 8u);
    EXPECT_EQ(search(asking_for(1e-4), [](const Knobs&) { return Errors{0, 0}; }).tried.size(), 1u);
}

}  // namespace

}  // namespace opaline::bake
