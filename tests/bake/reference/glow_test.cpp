// Volumes that send out light by themselves, against closed forms.
// Light that surfaces sent to volumes: a part of interreflection that paths tell apart.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/bake/reference/reference_support.h"
#include "tests/bake/reference/volume_support.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

using formats::TermSet;

formats::Environment even_sky(float value) {
    formats::Environment sky = make_white_sky();
    sky.pixel.assign(2, {value, value, value});
    return sky;
}

bake::Moments look_at_glow(std::vector<formats::Volume> volumes, float sky, glm::vec3 from,
                           glm::vec3 direction, std::uint32_t samples, TermSet terms) {
    Scene scene;
    scene.materials.resize(1);
    scene.volumes = std::move(volumes);
    const auto fixture = make_fixture(std::move(scene), even_sky(sky));
    bake::PathOptions options;
    options.terms = terms;
    return look(fixture->space(options), from, direction, samples);
}

// Within four standard errors and 1e-4 of rounding, in every band.
void expect_radiance(const bake::Moments& seen, glm::vec3 truth) {
    for (int band = 0; band < 3; ++band) {
        const double error = std::sqrt(seen.variance_of_mean()[band]);
        EXPECT_NEAR(seen.mean[band], static_cast<double>(truth[band]),
                    4 * error + 1e-4 * static_cast<double>(truth[band]))
            << "band " << band;
        EXPECT_LT(error, 0.02 * static_cast<double>(truth[band])) << "too noisy to tell";
    }
}

constexpr float kSize = 0.5f;

// The line through the middle of a blob: its density integrates to size sqrt(2 pi).
float column() {
    return kSize * std::sqrt(2 * std::numbers::pi_v<float>);
}

TEST(ReferenceGlow, WithoutScatteringABlobShowsItsOwnRadianceTimesWhatItAbsorbs) {
    formats::Volume blob = make_volume(make_blob(kSize, kSize / 8), 1, 0, 0);
    blob.sigma_t = {0.5f, 2, 8};
    const glm::vec3 own(3, 2, 1);
    make_it_glow(blob, own);
    const glm::vec3 depth = column() * glm::vec3(0.5f, 2, 8);
    expect_radiance(look_at_glow({blob}, 0, {-4, 0, 0}, {1, 0, 0}, 64000, TermSet::all),
                    own * (1.0f - glm::exp(-depth)));
}

TEST(ReferenceGlow, ItsLightNeedsNoDensity) {
    // A flame of Gaussian radiance beside a thin veil of density.
    formats::Volume flame = make_volume(make_blob(kSize, kSize / 8), 1, 0, 0);
    make_it_glow(flame, {5, 4, 3});
    for (float& value : flame.density.value) {
        value = 0;
    }
    flame.density.value.front() = 1e-6f;
    expect_radiance(look_at_glow({flame}, 0, {0, -4, 0}, {0, 1, 0}, 64000, TermSet::emitters),
                    column() * glm::vec3(5, 4, 3));
}

TEST(ReferenceGlow, InEquilibriumWithTheSkyAlbedosThatDifferFromPlaceToPlaceCannotBeSeen) {
    formats::Volume blob = make_volume(make_blob(kSize, kSize / 8), 3, 0, 0.7f);
    vary_albedo(blob,
                [](glm::dvec3 p) { return p.y > 0 ? glm::vec3(0) : glm::vec3(1, 0.9f, 0.3f); });
    const glm::vec3 from(-4, 0.1f, 0.1f), along(1, 0, 0);
    // Between its halves the sky alone does not hold.
    const bake::Moments dark = look_at_glow({blob}, 2, from, along, 16000, TermSet::all);
    EXPECT_LT(dark.mean.x, 1.9);
    make_it_glow(blob, glm::vec3(2));
    expect_radiance(look_at_glow({blob}, 2, from, along, 64000, TermSet::all), glm::vec3(2));
}

TEST(ReferenceGlow, LightOfVolumesIsThatOfEmittersAndAddsUpWithTheSkys) {
    formats::Volume blob = make_volume(make_blob(kSize, kSize / 8), 4, 0.8f, 0.3f);
    make_it_glow(blob, glm::vec3(7, 5, 3));
    formats::Volume dark = blob;
    dark.emission = {};
    const glm::vec3 from(-4, 0.3f, 0), direction(1, 0, 0);
    const auto seen = [&](const formats::Volume& volume, float sky, TermSet terms) {
        return look_at_glow({volume}, sky, from, direction, 64000, terms);
    };
    const bake::Moments own = seen(blob, 1, TermSet::emitters);
    const bake::Moments sky = seen(dark, 1, TermSet::all);
    const bake::Moments both = seen(blob, 1, TermSet::all);
    EXPECT_EQ(seen(dark, 1, TermSet::emitters).mean, glm::dvec3(0));
    for (int band = 0; band < 3; ++band) {
        const double error = std::sqrt(own.variance_of_mean()[band] + sky.variance_of_mean()[band] +
                                       both.variance_of_mean()[band]);
        EXPECT_NEAR(both.mean[band], own.mean[band] + sky.mean[band], 4 * error);
    }
}

using bake::TermSet;

// Smoke that absorbs nothing above a white floor, practically without an end, in even light: all
// is as bright as the sky.
std::unique_ptr<ReferenceFixture> smoke_above_floor() {
    Scene scene = make_scene({make_quad({-500, -1, -500}, {0, 0, 1000}, {1000, 0, 0})});
    scene.materials[0].base_color = {1, 1, 1};
    scene.volumes.push_back(make_volume(make_ball_grid(0.5, 0.125), 2, 1, 0.5f));
    return make_fixture(std::move(scene), make_white_sky());
}

bake::PathOptions scattered_last_by_volumes() {
    bake::PathOptions options;
    options.terms = TermSet::volume_single | TermSet::volume_multiple | TermSet::interreflection;
    options.by_volumes = true;
    return options;
}

TEST(ByVolumes, SmokeGivesBackWhatItTakesWhateverIsBehindIt) {
    const auto smoke = smoke_above_floor();
    constexpr std::uint32_t kSamples = 1 << 15;
    const double taken = 1 - std::exp(-2.0);
    for (const glm::vec3 direction :
         {glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(1, 0, 0)}) {
        const bake::Moments seen =
            look(*smoke, -0.8f * direction, direction, scattered_last_by_volumes(), kSamples);
        EXPECT_NEAR(seen.mean.y, taken, 0.02) << direction.y;
    }
}

TEST(ByVolumes, NothingIsCountedOfAPathThatMeetsASurfaceFirst) {
    const auto smoke = smoke_above_floor();
    const bake::Moments beside =
        look(*smoke, {3, 0, 0}, {0, -1, 0}, scattered_last_by_volumes(), 4096);
    EXPECT_EQ(beside.mean.y, 0);
    bake::PathOptions all = scattered_last_by_volumes();
    all.by_volumes = false;
    EXPECT_GT(look(*smoke, {3, 0, 0}, {0, -1, 0}, all, 4096).mean.y, 0);
}

}  // namespace

}  // namespace opaline::tests
