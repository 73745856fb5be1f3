// Media whose bands coincide: one stands for all three, in the bake, in the file and at run time.
#include <gtest/gtest.h>

#include "formats/opal/cubemap.h"
#include "formats/opal/write_opal.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

using formats::Medium;
using formats::PrimitiveRecord;
using formats::Rgb;
using tests::make_ball_on_floor;
using tests::make_grey_medium;
using tests::relight;

Medium forward_wax() {
    Medium medium = make_grey_medium(10, 0.2f);
    medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, 0.3f, 0, {}, {}};
    return medium;
}

// Kinds of rows: one term together, four apart.
struct Variant {
    const char* name;
    Medium medium;
    std::uint32_t phase_terms;
    bool separate;
};

std::vector<Variant> all_variants() {
    return {{"one term", make_grey_medium(10, 0.2f), 1, false},
            {"four terms by themselves", forward_wax(), 4, true}};
}

const PlanEntry& colour_of(const BakeResult& result) {
    return *find_entry(result.plan, "light.colour", 0);
}

// Above a floor that keeps every shortcut but this one from being taken.
BakeResult bake_grey(const formats::Scene& scene, bool forced, std::uint32_t phase_terms = 0,
                     bool separate = false) {
    BakeOptions options = tests::small_bake();
    options.set(kPhaseTerms, phase_terms);
    options.separate_terms = separate;
    forced ? simulate_all_but_bounces(options) : leave_bounces_out(options);
    return tests::bake_scene(scene, options);
}

// The ball's rows, decoded, are those of the first band of the other: bit for bit.
void expect_rows_of_first_band(const formats::Asset& grey, const formats::Asset& colour,
                               const char* what) {
    const PrimitiveRecord &one = grey.primitives[0], &three = colour.primitives[0];
    ASSERT_EQ(one.bands, 1u) << what;
    ASSERT_EQ(three.bands, 3u) << what;
    ASSERT_EQ(one.terms, three.terms) << what;
    const formats::RowRange grey_rows = grey.view().rows_of(0), rows = colour.view().rows_of(0);
    ASSERT_EQ(grey_rows.rows, rows.rows) << what;
    const std::size_t texels = formats::cubemap_texels(grey.view().cubemap_size);
    std::vector<float> own(texels), other(texels);
    double sum = 0;
    for (std::uint32_t row = 0; row < rows.rows; ++row) {
        formats::decode_row(grey.transport.view(), grey_rows, row, 0, own);
        formats::decode_row(colour.transport.view(), rows, row, 0, other);
        ASSERT_EQ(own, other) << what << ", row " << row;
        sum += static_cast<double>(own[0]);
    }
    EXPECT_NE(sum, 0) << what;
}

// A third of the ball's codes and scales. Indices of two bytes stay: of five bytes a coefficient
// three are left.
void expect_less_to_store(const formats::Asset& grey, const formats::Asset& colour,
                          const char* what) {
    const PrimitiveRecord &floor = grey.primitives[1], &other = colour.primitives[1];
    EXPECT_EQ(3 * floor.first_code, other.first_code) << what;
    EXPECT_EQ(3 * floor.first_band_row, other.first_band_row) << what;
    EXPECT_EQ(floor.first_row, other.first_row) << what;
    EXPECT_LT(static_cast<double>(formats::opal_size(grey.view())),
              0.7 * static_cast<double>(formats::opal_size(colour.view())))
        << what;
}

// Sums are taken in another order: what they round to differs.
void expect_same_light(const BakeResult& a, const BakeResult& b, const char* what) {
    for (const char* light : {"white", "studio", "sky:3,40"}) {
        const auto x = relight(a.asset.view(), light), y = relight(b.asset.view(), light);
        for (std::size_t i = 0; i < x.size(); ++i) {
            ASSERT_NEAR(x[i].r, y[i].r, 1e-5f) << what << ", " << light;
            ASSERT_NEAR(x[i].g, y[i].g, 1e-5f) << what << ", " << light;
            ASSERT_NEAR(x[i].b, y[i].b, 1e-5f) << what << ", " << light;
        }
        EXPECT_GT(x[0].g, 0.001f) << what << ", " << light;
    }
}

TEST(Grey, OneBandHasTheBitsOfEachOfThree) {
    for (const auto& [name, medium, terms, separate] : all_variants()) {
        const auto scene = make_ball_on_floor(medium);
        const BakeResult grey = bake_grey(scene, false, terms, separate);
        const BakeResult colour = bake_grey(scene, true, terms, separate);
        EXPECT_FALSE(colour_of(grey).on) << name;
        EXPECT_EQ(colour_of(grey).bound, 0) << name;
        EXPECT_TRUE(colour_of(colour).on && colour_of(colour).forced) << name;
        expect_rows_of_first_band(grey.asset, colour.asset, name);
        expect_less_to_store(grey.asset, colour.asset, name);
        expect_same_light(grey, colour, name);
        EXPECT_NEAR(grey.error.rms_relative, colour.error.rms_relative, 1e-5) << name;
    }
}

TEST(Grey, SlightlyBluerTwinKeepsThreeBands) {
    Medium medium = make_grey_medium(10, 0.2f);
    medium.sigma_a.b *= 1.000001f;
    ASSERT_NE(medium.sigma_a.b, medium.sigma_a.g);
    const BakeResult result = bake_grey(make_ball_on_floor(medium), false);
    EXPECT_TRUE(colour_of(result).on);
    EXPECT_FALSE(colour_of(result).forced);
    EXPECT_EQ(result.asset.primitives[0].bands, 3u);
    EXPECT_GE(colour_of(result).bound, find_entry(result.plan, "multiple", 0)->bound);
}

// Where light leaves as it entered, `--effects all` would simulate more than colour: instead a twin
// of another blue, whose red is the same.
TEST(Grey, DenseMediumHasTheBitsOfItsTwinsRed) {
    const Medium dense = make_grey_medium(2e4f, 2e3f);
    Medium bluer = dense;
    bluer.sigma_a.b *= 2;
    const auto bake_ball = [](const Medium& medium) {
        return bake_grey(tests::make_translucent_scene({tests::make_sphere(5)}, medium), false);
    };
    const BakeResult grey = bake_ball(dense), colour = bake_ball(bluer);
    ASSERT_FALSE(find_entry(grey.plan, "multiple.spread", 0)->on);
    ASSERT_FALSE(find_entry(colour.plan, "multiple.spread", 0)->on);
    expect_rows_of_first_band(grey.asset, colour.asset, "dense");
}

// Veins, vertex colours and the base colour multiply the light that leaves: rows know nothing of
// them.
TEST(Grey, ColouredSurfaceOfAGreyMediumKeepsItsColourWithOneBand) {
    auto scene = make_ball_on_floor(make_grey_medium(10, 0.2f));
    scene.materials[0].base_color = {0.9f, 0.5f, 0.2f};
    scene.materials[0].marble = formats::Marble{0.3f, {{1, 0.2f, 0.2f}, {0.2f, 1, 0.6f}}};
    for (std::size_t v = 0; v < scene.primitives[0].position.size(); ++v) {
        scene.primitives[0].color.push_back({1, v % 2 == 0 ? 1.0f : 0.5f, 1});
    }
    const BakeResult grey = bake_grey(scene, false), colour = bake_grey(scene, true);
    expect_rows_of_first_band(grey.asset, colour.asset, "veined");
    expect_same_light(grey, colour, "veined");
    const Rgb c = relight(grey.asset.view(), "white")[0];
    EXPECT_GT(std::abs(c.r - c.b), 0.05f);
}

TEST(Grey, MediumThatLetsNothingOutHasNoColour) {
    Medium black;
    black.sigma_s = {0.1f, 0.1f, 0.05f};
    black.sigma_a = {100, 110, 120};
    const BakeResult result = bake_grey(make_ball_on_floor(black), false);
    ASSERT_FALSE(find_entry(result.plan, "single", 0)->on);
    ASSERT_FALSE(find_entry(result.plan, "multiple", 0)->on);
    EXPECT_FALSE(colour_of(result).on);
    EXPECT_EQ(result.asset.primitives[0].bands, 1u);
}

}  // namespace
}  // namespace opaline::bake
