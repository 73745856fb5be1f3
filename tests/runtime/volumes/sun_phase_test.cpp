// The tables that a sun's light meets in forward volumes, against the exact law of directions after
// many scatterings along a line.
#include "runtime/volumes/sun_phase.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "formats/opal/phase_table.h"
#include "tests/runtime/volumes/synthetic_volume.h"

namespace opaline::runtime {
namespace {

using formats::kPhaseEntries;

// What a bake makes of a Henyey-Greenstein function.
formats::Volumes forward_volume(double g) {
    test::TestVolume volume;
    volume.single_terms = 25;
    test::scatter_forward(volume, g);
    formats::Volumes volumes = test::make_volumes(test::kSize);
    test::add_volume(volumes, volume);
    return volumes;
}

SunPhase phase_of(const formats::Volumes& volumes) {
    return make_sun_phase(volumes.records[0], volumes.view().phase_of(0));
}

// sum over k of (2 k + 1) / (4 pi) m(k) P_k(c), k < degrees.
template <typename Moment>
double sum_legendre(double c, int degrees, const Moment& moment) {
    double sum = 0, before = 0, legendre = 1;
    for (int k = 0; k < degrees; ++k) {
        sum += (2 * k + 1) / (4 * std::numbers::pi) * moment(k) * legendre;
        const double next = ((2 * k + 1) * c * legendre - k * before) / (k + 1);
        before = legendre;
        legendre = next;
    }
    return sum;
}

// sum of tables, `before` and `behind` the shares that come through, of light that is scattered
// `albedo` times as often as it collides.
double eval(const SunPhase& phase, double c, float albedo, double before, double behind) {
    const formats::Rgb grey{albedo, albedo, albedo};
    const auto through = [&](double share) {
        const auto s = static_cast<float>(share);
        return find_sun_through(phase, grey, {s, s, s});
    };
    const SunThrough v = through(before), t = through(behind);
    double sum = 0;
    for (std::size_t j = 0; j < phase.terms; ++j) {
        const auto table = std::span(phase.table).subspan(j * kPhaseEntries, kPhaseEntries);
        sum += static_cast<double>(v[j].g * t[j].g *
                                   formats::eval_phase_table(table, static_cast<float>(c)));
    }
    return sum;
}

// Scattered light of depth L [Goudsmit1940], e^-L sum (2 k + 1) / (4 pi) (e^(L g^k) - 1) P_k, is
// what suns show and what rows of degrees below 5 hold of light that was scattered twice or more.
TEST(SunPhase, WithRowsIsTheExactLawOfManyForwardScatteringsAlongALine) {
    for (const double g : {0.6, 0.75, 0.85, 0.9}) {
        const SunPhase phase = phase_of(forward_volume(g));
        ASSERT_EQ(phase.terms, kMaxSunTerms);
        const double f = std::pow(g, 5);
        for (const double depth : {0.1, 1.0, 3.0, 6.0}) {
            for (const double degrees : {0.0, 3.0, 8.0, 15.0, 25.0, 40.0, 60.0}) {
                const double c = std::cos(degrees * std::numbers::pi / 180);
                const double exact = std::exp(-depth) * sum_legendre(c, 200, [&](int k) {
                                         return std::expm1(depth * std::pow(g, k));
                                     });
                const double rows = sum_legendre(c, 5, [&](int k) {
                    const double x = depth * (std::pow(g, k) - f);
                    return std::expm1(x) - x;
                });
                constexpr float kAlbedo = 0.9f;
                for (const double share : {0.0, 0.4, 1.0}) {  // of the line, before the place
                    const double tau = depth * (1 - f) / static_cast<double>(kAlbedo);
                    const double q = eval(phase, c, kAlbedo, std::exp(-share * tau),
                                          std::exp(-(1 - share) * tau));
                    const double shown = std::exp(-depth * (1 - f)) * (depth * (1 - f) * q + rows);
                    EXPECT_NEAR(shown, exact, 0.03 * exact)
                        << g << " depth " << depth << " at " << degrees << " degrees";
                }
            }
        }
    }
}

TEST(SunPhase, OfLightThatDoesNotComeThroughIsFinite) {
    const SunPhase phase = phase_of(forward_volume(0.85));
    for (const float share : {0.0f, -1.0f, 2.0f, 1e-38f}) {
        for (const formats::Rgb t : find_sun_through(phase, {1, 0.5f, 0}, {share, share, share})) {
            for (const float x : {t.r, t.g, t.b}) {
                EXPECT_TRUE(x >= 0 && x <= 1) << share;
            }
        }
    }
}

// Two lobes have moments of their own; a table that is not of the moments' function is shown as it
// is.
TEST(SunPhase, OfOtherPhaseFunctionsIsTheFilesTable) {
    const auto expect_table = [](const formats::Volumes& volumes) {
        const SunPhase phase = phase_of(volumes);
        EXPECT_EQ(phase.terms, 1u);
        EXPECT_EQ(phase.power[0], 0);
        const auto table = volumes.view().phase_of(0);
        EXPECT_TRUE(std::ranges::equal(phase.table, table));
    };
    formats::Volumes lobes = forward_volume(0.85);
    lobes.records[0].moment = {1, 0.6f, 0.5f, 0.3f, 0.2f};
    expect_table(lobes);
    formats::Volumes other = forward_volume(0.85);
    other.records[0].moment = forward_volume(0.7).records[0].moment;
    expect_table(other);
    formats::Volumes few = forward_volume(0.85);
    few.records[0].single_terms = 16;
    expect_table(few);
    formats::Volumes damaged = forward_volume(0.85);
    damaged.records[0].moment[2] = NAN;
    expect_table(damaged);
}

TEST(SunPhase, TablesOfShadersAreFinite) {
    formats::Volumes volumes = forward_volume(0.85);
    const SunPhase phase = phase_of(volumes);
    const std::vector<float> packed = pack_sun_tables(volumes.view());
    EXPECT_TRUE(std::ranges::equal(packed, phase.table));
    volumes.phase[3] = NAN;
    volumes.phase[4] = -1;
    volumes.phase[5] = HUGE_VALF;
    const std::vector<float> damaged = pack_sun_tables(volumes.view());
    ASSERT_EQ(damaged.size(), kMaxSunTerms * kPhaseEntries);
    EXPECT_TRUE(std::ranges::all_of(damaged, [](float x) { return std::isfinite(x) && x >= 0; }));
    EXPECT_EQ(damaged[6], volumes.phase[6]);
}

}  // namespace
}  // namespace opaline::runtime
